#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <zip.h>
#include <pugixml.hpp>

#include "forward/base/digest.h"
#include "forward/base/error.h"
#include "forward/base/file_output.h"
#include "measurement/formats/little_endian_writer.h"
#include "measurement/formats/surface_output.h"
#include "measurement/formats/text_values.h"

namespace mezzotint {

namespace {

// The first day that a zip can name: a real date would make every archive different.
constexpr zip_uint16_t fixed_date = 0x0021, fixed_time = 0;
// The low bits of measured heights are noise: more effort packs them no better.
constexpr zip_uint32_t fastest_deflate = 1;

constexpr const char* data_member = "bindata/data.bin";

class X3pOutput {
public:
  explicit X3pOutput(const std::filesystem::path& path) : path_(path) {
    int code = 0;
    archive_ = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
    if (archive_ == nullptr) throw DeviceError("cannot write " + path.string());
  }
  ~X3pOutput() {
    if (archive_ != nullptr) zip_discard(archive_);
  }
  X3pOutput(const X3pOutput&) = delete;
  X3pOutput& operator=(const X3pOutput&) = delete;

  // The bytes must outlive close().
  void add(const char* name, const std::string& bytes) {
    zip_source_t* const source = zip_source_buffer(archive_, bytes.data(), bytes.size(), 0);
    check(source != nullptr);
    const zip_int64_t index = zip_file_add(archive_, name, source, ZIP_FL_ENC_UTF_8);
    if (index < 0) zip_source_free(source);
    check(index >= 0);
    const auto member = static_cast<zip_uint64_t>(index);
    check(zip_set_file_compression(archive_, member, ZIP_CM_DEFLATE, fastest_deflate) == 0);
    check(zip_file_set_dostime(archive_, member, fixed_time, fixed_date, 0) == 0);
  }
  void close() {
    check(zip_close(archive_) == 0);
    archive_ = nullptr;
  }

private:
  void check(bool good) const {
    if (!good) throw DeviceError(fmt::format("cannot write {}: {}", path_.string(), zip_strerror(archive_)));
  }

  std::filesystem::path path_;
  zip_t* archive_ = nullptr;
};

// Metres in double, x fastest, y growing with the row; NaN is missing.
std::string points_of(const HeightField& field) {
  std::string bytes;
  bytes.reserve(8 * field.grid().size());
  std::vector<double> line(field.columns());
  for (std::size_t row = 0; row < field.rows(); ++row) {
    for (std::size_t column = 0; column < line.size(); ++column) {
      const float z = field.at(column, row);
      const double missing = std::numeric_limits<double>::quiet_NaN();
      line[column] = std::isnan(z) ? missing : (field.datum() + Length::from_um(z)).m();
    }
    append_little_endian(bytes, std::span<const double>(line));
  }
  return bytes;
}

void add_text(pugi::xml_node parent, const char* name, const std::string& text) {
  parent.append_child(name).text().set(text.c_str());
}

void add_axis(pugi::xml_node axes, const char* name, const char* type, double increment) {
  pugi::xml_node axis = axes.append_child(name);
  add_text(axis, "AxisType", type);
  add_text(axis, "DataType", "D");
  add_text(axis, "Increment", fmt::format("{:.17g}", increment));
  add_text(axis, "Offset", "0");
}

std::string value_of(const Provenance& provenance, const char* key, const char* otherwise) {
  const auto found = provenance.find(key);
  return found == provenance.end() ? otherwise : clean_text(found->second);
}

// The standard wants a date with the rest of this record: where none is known, the record is left out.
void add_provenance(pugi::xml_node root, const std::string& title, const Provenance& provenance) {
  if (provenance.find("date") == provenance.end()) return;
  constexpr const char* unknown = "unknown";
  pugi::xml_node record = root.append_child("Record2");
  add_text(record, "Date", value_of(provenance, "date", unknown));
  pugi::xml_node instrument = record.append_child("Instrument");
  add_text(instrument, "Manufacturer", value_of(provenance, "manufacturer", unknown));
  add_text(instrument, "Model", value_of(provenance, "model", unknown));
  add_text(instrument, "Serial", value_of(provenance, "serial", unknown));
  add_text(instrument, "Version", value_of(provenance, "version", unknown));
  add_text(record, "CalibrationDate", value_of(provenance, "calibration date", unknown));
  pugi::xml_node probe = record.append_child("ProbingSystem");
  add_text(probe, "Type", value_of(provenance, "probing", "NonContacting"));
  add_text(probe, "Identification", value_of(provenance, "probe", unknown));
  add_text(record, "Comment", value_of(provenance, "comment", clean_text(title).c_str()));
}

std::string document_of(const HeightField& field, const std::string& title, const Provenance& provenance,
                        const std::string& points) {
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  pugi::xml_node root = document.append_child("p:ISO5436_2");
  root.append_attribute("xmlns:p") = "http://www.opengps.eu/2008/ISO5436_2";
  pugi::xml_node record1 = root.append_child("Record1");
  add_text(record1, "Revision", "ISO5436 - 2000");
  add_text(record1, "FeatureType", "SUR");
  pugi::xml_node axes = record1.append_child("Axes");
  add_axis(axes, "CX", "I", field.grid().pitch_x.m());
  add_axis(axes, "CY", "I", field.grid().pitch_y.m());
  add_axis(axes, "CZ", "A", 1.0);
  add_provenance(root, title, provenance);
  pugi::xml_node record3 = root.append_child("Record3");
  pugi::xml_node size = record3.append_child("MatrixDimension");
  add_text(size, "SizeX", std::to_string(field.columns()));
  add_text(size, "SizeY", std::to_string(field.rows()));
  add_text(size, "SizeZ", "1");
  pugi::xml_node link = record3.append_child("DataLink");
  add_text(link, "PointDataLink", data_member);
  add_text(link, "MD5ChecksumPointData", md5_hex(std::as_bytes(std::span(points))));
  add_text(root.append_child("Record4"), "ChecksumFile", "md5checksum.hex");
  std::ostringstream text;
  document.save(text, "  ", pugi::format_indent, pugi::encoding_utf8);
  return text.str();
}

}  // namespace

// Source   ISO 25178-72:2017, Annex A.
void write_x3p(const HeightField& field, const std::string& title, const Provenance& provenance,
               const std::filesystem::path& path) {
  const std::string points = points_of(field);
  const std::string document = document_of(field, title, provenance, points);
  const std::string checksum = md5_hex(std::as_bytes(std::span(document))) + " *main.xml\n";
  write_aside(path, [&](const std::filesystem::path& temporary) {
    X3pOutput archive(temporary);
    archive.add("main.xml", document);
    archive.add(data_member, points);
    archive.add("md5checksum.hex", checksum);
    archive.close();
  });
}

}  // namespace mezzotint
