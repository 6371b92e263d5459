#pragma once

#include <filesystem>
#include <string>

#include "forward/base/error.h"

namespace mezzotint {

/// A member of an archive, for complaints about it.
struct MemberPlace {
  std::filesystem::path archive;
  std::string member;

  [[noreturn]] void refuse(std::string_view problem) const { throw FileError(archive, member, problem); }
};

}  // namespace mezzotint
