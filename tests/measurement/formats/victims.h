#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tests/fuzz/readers.h"

// Small whole files of every format, to be damaged; also the seeds of the fuzz targets.
namespace mezzotint::test {

using Reader = void (*)(std::span<const std::byte>);

struct Victim {
  const char* format;  ///< the fuzz target, and the folder of the corpus
  const char* name;
  Reader reader = nullptr;
  std::string bytes;
  std::size_t dispensable = 0;         ///< what may be cut off at the end without harm to the heights
  bool any_part_may_be_whole = false;  ///< text: the beginning of a list of numbers is a list of numbers
};
std::vector<Victim> victims();

std::string small_al3d();
std::string small_gwy();
std::string binary_xml();
std::string listed_xml();
std::string x3p_of(const std::string& xml, std::uint16_t method);

}  // namespace mezzotint::test
