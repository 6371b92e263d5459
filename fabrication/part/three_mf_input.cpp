#include "fabrication/part/three_mf_input.h"

#include "forward/base/error.h"

namespace mezzotint {

RawMesh read_three_mf(const std::filesystem::path& path, std::vector<std::string>&) {
  throw FileError(path, "", "3MF is not read yet");
}

}  // namespace mezzotint
