#include "inverse/search/evaluation_log.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <nlohmann/json.hpp>

#include "forward/base/error.h"
#include "forward/base/file_input.h"

namespace mezzotint {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* format_name = "mezzotint evaluations 1";

Json to_json(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0.0 ? "inf" : "-inf";
  return value;
}

double number_from(const Json& json) {
  if (json.is_number()) return json.get<double>();
  const auto text = json.get<std::string>();
  if (text == "nan") return std::numeric_limits<double>::quiet_NaN();
  if (text == "inf" || text == "-inf") {
    const double infinity = std::numeric_limits<double>::infinity();
    return text == "inf" ? infinity : -infinity;
  }
  throw std::invalid_argument("a number is expected");
}

Json to_json(const std::vector<double>& values) {
  Json array = Json::array();
  for (const double value : values) array.push_back(to_json(value));
  return array;
}

std::vector<double> numbers_from(const Json& array) {
  std::vector<double> values;
  for (const Json& value : array) values.push_back(number_from(value));
  return values;
}

std::string line_of(const LoggedEvaluation& e) {
  return Json{{"stage", e.stage}, {"values", to_json(e.values)}, {"results", to_json(e.results)}}.dump() + "\n";
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

}  // namespace

EvaluationLog::EvaluationLog(std::filesystem::path file, const std::string& digest) : file_(std::move(file)) {
  const std::string header = Json{{"format", format_name}, {"problem", digest}}.dump() + "\n";
  std::error_code no_file;
  const std::uintmax_t size = std::filesystem::file_size(file_, no_file);
  const bool is_new = no_file || size == 0;
  if (!is_new) read(header);
  stream_.open(file_, std::ios::binary | std::ios::app);
  if (is_new) stream_ << header << std::flush;
  if (!stream_)
    throw DeviceError(file_.string() +
                      ": the search's log cannot be written; is the disk full, or the folder not there?");
}

void EvaluationLog::read(const std::string& header) {
  std::ifstream in(file_, std::ios::binary);
  std::string line;
  std::uintmax_t whole = 0;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    if (in.eof()) break;  // cut off before its end: it counts as not written
    const std::string place = "line " + std::to_string(number);
    if (number == 1) {
      if (line + "\n" != header) {
        throw FileError(file_, place,
                        "belongs to another search, or to another version of the program; start anew without it");
      }
    } else {
      try {
        const Json json = Json::parse(line);
        earlier_.push_back(
            {json.at("stage").get<std::string>(), numbers_from(json.at("values")), numbers_from(json.at("results"))});
      } catch (const std::exception&) {
        throw FileError(file_, place, "is no evaluation of a search; take this line and those below away");
      }
    }
    whole += line.size() + 1;
  }
  in.close();
  if (whole == 0) throw FileError(file_, "line 1", "is cut off; take the file away to start anew");
  std::filesystem::resize_file(file_, whole);
  found_ = earlier_.size();
}

std::optional<std::vector<double>> EvaluationLog::replay(const std::string& stage, const std::vector<double>& values) {
  if (next_ == earlier_.size()) return {};
  const LoggedEvaluation& next = earlier_[next_++];
  if (next.stage != stage || !same_bits(next.values, values)) {
    throw FileError(file_, "line " + std::to_string(next_ + 1),
                    "the search asks for another evaluation (" + stage + ") than the log has here (" + next.stage +
                        "): it was made on another kind of processor or by another build; start anew without it");
  }
  return next.results;
}

void EvaluationLog::append(const LoggedEvaluation& evaluation) {
  require(next_ == earlier_.size(), "an evaluation is appended to a log whose earlier ones were not asked for");
  stream_ << line_of(evaluation) << std::flush;
  if (!stream_) throw DeviceError(file_.string() + ": the search's log cannot be written; is the disk full?");
}

}  // namespace mezzotint
