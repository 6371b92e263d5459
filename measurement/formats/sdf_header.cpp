#include "measurement/formats/sdf_header.h"

#include <cmath>

#include <fmt/format.h>

#include "forward/base/error.h"
#include "measurement/formats/text_values.h"

namespace mezzotint {

namespace {

constexpr std::size_t version_bytes = 8, manufacturer_bytes = 10, date_bytes = 12;
constexpr int largest_type = 7;

using Fields = std::map<std::string, std::string, std::less<>>;

void add_provenance(SdfHeader& header, const char* key, std::string_view text) {
  const std::string value = clean_text(text.substr(0, text.find('\0')));
  if (!value.empty()) header.provenance[key] = value;
}

std::string_view fixed_text(ByteReader& reader, std::size_t size, std::string_view what) {
  const auto bytes = reader.take(size, what);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

template <class Reader>
void require_plain(const SdfHeader& header, const Reader& reader, std::uint64_t compression, std::uint64_t check) {
  if (compression != 0) reader.fail(fmt::format("compression {}; only 0 (none) is read", compression));
  if (check != 0) reader.fail(fmt::format("a checksum of type {}; only 0 (none) is read", check));
  if (header.data_type > largest_type) {
    reader.fail(fmt::format("data of type {}; 0 to {} are known", header.data_type, largest_type));
  }
  if (!std::isfinite(header.z_scale_m) || header.z_scale_m == 0.0) {
    reader.fail(fmt::format("Zscale is {}; a number other than 0 belongs there", header.z_scale_m));
  }
}

Fields take_fields(TextScanner& scanner) {
  constexpr std::size_t most_fields = 100;
  Fields fields;
  while (true) {
    if (scanner.at_end()) scanner.fail("the header has no end; a line with * ends it");
    const std::string_view line = trimmed(scanner.take_line());
    if (line == "*") return fields;
    if (line.empty() || line.front() == ';') continue;
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) scanner.fail("no line of a header; KEY = VALUE belongs there");
    if (fields.size() == most_fields) scanner.fail("more lines than a header has");
    std::string_view value = line.substr(equals + 1);
    value = trimmed(value.substr(0, value.find(';')));  // a comment
    fields[lower_case(trimmed(line.substr(0, equals)))] = std::string(value);
  }
}

const std::string& field(const Fields& fields, const TextScanner& scanner, std::string_view key) {
  const auto found = fields.find(lower_case(key));
  if (found == fields.end()) scanner.fail(fmt::format("the header has no {}", key));
  return found->second;
}

std::uint64_t count(const Fields& fields, const TextScanner& scanner, std::string_view key) {
  const std::string& text = field(fields, scanner, key);
  const auto value = to_count(text);
  if (!value) scanner.fail(fmt::format("{} is \"{}\"; a whole number belongs there", key, clean_text(text)));
  return *value;
}

double number(const Fields& fields, const TextScanner& scanner, std::string_view key) {
  const std::string& text = field(fields, scanner, key);
  const auto value = to_number(text);
  if (!value) scanner.fail(fmt::format("{} is \"{}\"; a number belongs there", key, clean_text(text)));
  return *value;
}

}  // namespace

SdfHeader sdf_version(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  SdfHeader header;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), version_bytes));
  const std::string_view kind = text.substr(std::min<std::size_t>(1, text.size()));
  header.ascii = text.starts_with('a') || text.starts_with('A');
  header.forerunner = kind == "BCR-1.0";
  header.wide_counts = kind == "ISO-2.0";
  if (!header.forerunner && kind != "ISO-1.0" && kind != "ISO-2.0") {
    throw FileError(path, "byte 0",
                    fmt::format("is of version \"{}\"; ISO-1.0, ISO-2.0 and BCR-1.0 are read", clean_text(kind)));
  }
  return header;
}

void take_sdf_header(SdfHeader& header, ByteReader& reader) {
  add_provenance(header, "manufacturer", fixed_text(reader, manufacturer_bytes, "the manufacturer"));
  add_provenance(header, "created", fixed_text(reader, date_bytes, "a date"));
  add_provenance(header, "modified", fixed_text(reader, date_bytes, "a date"));
  const auto take_count = [&] {
    return header.wide_counts ? reader.take_number<std::uint32_t>("a count")
                              : std::uint32_t{reader.take_number<std::uint16_t>("a count")};
  };
  header.grid.columns = take_count();
  header.grid.rows = take_count();
  header.grid.pitch_x_m = reader.take_number<double>("a scale");
  header.grid.pitch_y_m = reader.take_number<double>("a scale");
  header.z_scale_m = reader.take_number<double>("a scale");
  reader.take_number<double>("the resolution");
  const auto compression = reader.take_number<std::uint8_t>("the compression");
  header.data_type = reader.take_number<std::uint8_t>("the type");
  const auto check = reader.take_number<std::uint8_t>("the type of the checksum");
  require_plain(header, reader, compression, check);
}

void take_sdf_header(SdfHeader& header, TextScanner& scanner) {
  scanner.take_line();
  const Fields fields = take_fields(scanner);
  header.grid = {count(fields, scanner, "NumPoints"), count(fields, scanner, "NumProfiles"),
                 number(fields, scanner, "Xscale"), number(fields, scanner, "Yscale")};
  header.z_scale_m = number(fields, scanner, "Zscale");
  header.data_type = static_cast<int>(std::min<std::uint64_t>(count(fields, scanner, "DataType"), 1000));
  const std::pair<const char*, const char*> texts[] = {
      {"manufacturer", "manufacid"}, {"created", "createdate"}, {"modified", "moddate"}};
  for (const auto& [key, name] : texts) {
    if (const auto found = fields.find(name); found != fields.end()) add_provenance(header, key, found->second);
  }
  require_plain(header, scanner, count(fields, scanner, "Compression"), count(fields, scanner, "CheckType"));
}

}  // namespace mezzotint
