#include <cstdint>

#include "forward/base/error.h"
#include MEZZOTINT_FUZZED_READERS

// Any bytes are read, or refused with a FileError: everything else is a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    mezzotint::fuzzed::MEZZOTINT_FUZZED({reinterpret_cast<const std::byte*>(data), size});
  } catch (const mezzotint::FileError&) {
  }
  return 0;
}
