#include "forward/base/error.h"

namespace mezzotint {

namespace {

std::string located(const std::filesystem::path& path, std::string_view place, std::string_view problem) {
  std::string message = path.string() + ": ";
  if (!place.empty()) message.append(place).append(": ");
  return message.append(problem);
}

}  // namespace

FileError::FileError(const std::filesystem::path& path, std::string_view place, std::string_view problem)
    : Error(located(path, place, problem), ExitStatus::BadInput) {}

}  // namespace mezzotint
