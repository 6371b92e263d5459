// No tests: the builders of the other files here (the name lets CMake find it).
#include "tests/measurement/formats/file_builders.h"

#include <array>

namespace mezzotint::test {

namespace {

std::string padded_text(std::string text, std::size_t size) {
  text.resize(size, '\0');
  return text;
}

std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1U ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

// A deflate stream of one stored block.
std::string deflated(const std::string& content) {
  std::string stream = "\x01";
  append(stream, static_cast<std::uint16_t>(content.size()));
  append(stream, static_cast<std::uint16_t>(~content.size()));
  return stream + content;
}

// The fields that a local header and an entry of the directory share, from "version needed" on.
void append_common(std::string& bytes, const ZipMember& member, std::size_t packed_size) {
  const auto declared =
      member.declared_size < 0 ? member.content.size() : static_cast<std::size_t>(member.declared_size);
  append(bytes, std::uint16_t{20});
  append(bytes, std::uint16_t{0});
  append(bytes, member.method);
  append(bytes, std::uint16_t{0});
  append(bytes, std::uint16_t{0});  // 1980-00-00
  append(bytes, crc32(member.content));
  append(bytes, static_cast<std::uint32_t>(packed_size));
  append(bytes, static_cast<std::uint32_t>(declared));
  append(bytes, static_cast<std::uint16_t>(member.name.size()));
  append(bytes, std::uint16_t{0});
}

struct ZipBody {
  std::string members, directory;
};

ZipBody zip_body(const std::vector<ZipMember>& members) {
  ZipBody body;
  for (const ZipMember& member : members) {
    const std::string packed = member.method == 8 ? deflated(member.content) : member.content;
    body.directory += "PK\x01\x02";
    append(body.directory, std::uint16_t{20});
    append_common(body.directory, member, packed.size());
    body.directory += std::string(10, '\0');
    append(body.directory, static_cast<std::uint32_t>(body.members.size()));
    body.directory += member.name;
    body.members += "PK\x03\x04";
    append_common(body.members, member, packed.size());
    body.members += member.name + packed;
  }
  return body;
}

std::string end_record(const ZipBody& body, std::uint16_t count) {
  std::string end = "PK\x05\x06";
  end += std::string(4, '\0');
  append(end, count);
  append(end, count);
  append(end, static_cast<std::uint32_t>(body.directory.size()));
  append(end, static_cast<std::uint32_t>(body.members.size()));
  append(end, std::uint16_t{0});
  return end;
}

std::string element(const std::string& prefix, const std::string& name, const std::string& content) {
  return "<" + prefix + name + ">" + content + "</" + prefix + name + ">";
}

}  // namespace

std::string build_al3d(const Al3dRecipe& recipe) {
  std::map<std::string, std::string> tags = {{"Cols", std::to_string(recipe.columns)},
                                             {"Rows", std::to_string(recipe.rows)},
                                             {"PixelSizeXMeter", "4.38027e-07"},
                                             {"PixelSizeYMeter", "8.76054e-07"},
                                             {"InvalidPixelValue", "3.000000028082e+15"},
                                             {"NumberOfPlanes", "1"},
                                             {"IconOffset", "0"},
                                             {"DepthImageOffset", ""},
                                             {"TextureImageOffset", "0"}};
  std::string depth;
  for (std::size_t i = 0; i < recipe.heights_m.size(); ++i) {
    append(depth, recipe.heights_m[i]);
    const bool row_ends = (i + 1) % recipe.columns == 0;
    if (row_ends && recipe.padded_rows) depth.resize((depth.size() + 7) / 8 * 8, '\x3F');  // no harmless zeros
  }
  std::size_t count = tags.size();
  for (const auto& [key, value] : recipe.tags) count += tags.count(key) == 0 ? 1 : 0;
  const std::size_t header_end = 17 + 52 * (count + 2) + 256;
  tags["DepthImageOffset"] = std::to_string(header_end);
  if (recipe.with_texture) tags["TextureImageOffset"] = std::to_string(header_end + depth.size());
  for (const auto& [key, value] : recipe.tags) tags[key] = value;

  std::string bytes("AliconaImaging\0\r\n", 17);
  const auto add_tag = [&](const std::string& key, const std::string& value) {
    bytes += padded_text(key, 20) + padded_text(value, 30) + "\r\n";
  };
  add_tag("Version", "1");
  add_tag("TagCount", std::to_string(count));
  for (const auto& [key, value] : tags) add_tag(key, value);
  bytes += padded_text("", 254) + "\r\n" + depth;
  if (recipe.with_texture) bytes += std::string((recipe.columns + 7) / 8 * 8 * recipe.rows, '\x80');
  return bytes;
}

GwyBuilder& GwyBuilder::component(std::string_view name, char type) {
  bytes_.append(name).push_back('\0');
  bytes_.push_back(type);
  return *this;
}

void GwyBuilder::nested(std::string_view type, const GwyBuilder& content) {
  bytes_.append(type).push_back('\0');
  append(bytes_, static_cast<std::uint32_t>(content.bytes_.size()));
  bytes_ += content.bytes_;
}

GwyBuilder& GwyBuilder::integer(std::string_view name, std::int32_t value) {
  append(component(name, 'i').bytes_, value);
  return *this;
}

GwyBuilder& GwyBuilder::real(std::string_view name, double value) {
  append(component(name, 'd').bytes_, value);
  return *this;
}

GwyBuilder& GwyBuilder::text(std::string_view name, std::string_view value) {
  component(name, 's').bytes_.append(value).push_back('\0');
  return *this;
}

GwyBuilder& GwyBuilder::reals(std::string_view name, const std::vector<double>& values) {
  append(component(name, 'D').bytes_, static_cast<std::uint32_t>(values.size()));
  for (const double value : values) append(bytes_, value);
  return *this;
}

GwyBuilder& GwyBuilder::texts(std::string_view name, const std::vector<std::string>& values) {
  append(component(name, 'S').bytes_, static_cast<std::uint32_t>(values.size()));
  for (const std::string& value : values) bytes_.append(value).push_back('\0');
  return *this;
}

GwyBuilder& GwyBuilder::object(std::string_view name, std::string_view type, const GwyBuilder& content) {
  component(name, 'o').nested(type, content);
  return *this;
}

GwyBuilder& GwyBuilder::objects(std::string_view name, std::string_view type, const std::vector<GwyBuilder>& contents) {
  append(component(name, 'O').bytes_, static_cast<std::uint32_t>(contents.size()));
  for (const GwyBuilder& content : contents) nested(type, content);
  return *this;
}

std::string GwyBuilder::file() const {
  GwyBuilder outermost;
  outermost.nested("GwyContainer", *this);
  return "GWYP" + outermost.bytes_;
}

GwyBuilder gwy_field(std::int32_t columns, std::int32_t rows, double width, double height,
                     const std::vector<double>& values, std::string_view lateral_unit, std::string_view height_unit) {
  GwyBuilder field;
  field.integer("xres", columns).integer("yres", rows).real("xreal", width).real("yreal", height);
  if (!lateral_unit.empty()) field.object("si_unit_xy", "GwySIUnit", GwyBuilder().text("unitstr", lateral_unit));
  if (!height_unit.empty()) field.object("si_unit_z", "GwySIUnit", GwyBuilder().text("unitstr", height_unit));
  return field.reals("data", values);
}

std::string build_zip(const std::vector<ZipMember>& members) {
  const ZipBody body = zip_body(members);
  return body.members + body.directory + end_record(body, static_cast<std::uint16_t>(members.size()));
}

std::string build_zip64(const std::vector<ZipMember>& members, std::uint64_t promised_members) {
  const ZipBody body = zip_body(members);
  std::string bytes = body.members + body.directory;
  const std::uint64_t record_at = bytes.size();
  bytes += "PK\x06\x06";
  append(bytes, std::uint64_t{44});
  append(bytes, std::uint32_t{0x002D002D});
  append(bytes, std::uint64_t{0});  // both disk numbers
  append(bytes, promised_members);
  append(bytes, promised_members);
  append(bytes, std::uint64_t{body.directory.size()});
  append(bytes, std::uint64_t{body.members.size()});
  bytes += "PK\x06\x07";
  append(bytes, std::uint32_t{0});
  append(bytes, record_at);
  append(bytes, std::uint32_t{1});
  return bytes + end_record(body, 0xFFFF);
}

std::string build_main_xml(const X3pRecipe& recipe) {
  const auto e = [&](const std::string& name, const std::string& content) {
    return element(recipe.prefix, name, content);
  };
  const std::string axis = e("AxisType", "I") + e("DataType", "D") + e("Increment", "1.5e-6") + e("Offset", "0");
  const std::string size =
      e("SizeX", std::to_string(recipe.columns)) + e("SizeY", std::to_string(recipe.rows)) + e("SizeZ", "1");
  const std::string record1 = e(
      "Record1", e("FeatureType", recipe.feature) + e("Axes", e("CX", axis) + e("CY", axis) + e("CZ", recipe.z_axis)));
  const std::string record2 = e("Record2", e("Date", "2020-02-02") + e("Instrument", e("Model", "a microscope")));
  const std::string record3 = e("Record3", e("MatrixDimension", size) + recipe.record3);
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?><p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\">" +
         record1 + record2 + record3 + "</p:ISO5436_2>";
}

std::string data_link(const std::string& md5, bool with_validity) {
  std::string link = element("", "PointDataLink", "bindata/data.bin");
  if (!md5.empty()) link += element("", "MD5ChecksumPointData", md5);
  if (with_validity) link += element("", "ValidPointsLink", "bindata/valid.bin");
  return element("", "DataLink", link);
}

}  // namespace mezzotint::test
