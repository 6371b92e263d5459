#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <OpenImageIO/filesystem.h>

namespace mezzotint {

/// A picture's bytes in memory, for OpenImageIO to read from. Its own reader of memory (2.4.7) subtracts before it
/// looks: from a place beyond the end, or before the beginning, as a damaged table of an OpenEXR file names it, it
/// copies what lies there. This one gives nothing.
class BoundedMemory : public OIIO::Filesystem::IOMemReader {
public:
  using IOMemReader::IOMemReader;

  std::size_t read(void* to, std::size_t count) override {
    const std::size_t got = pread(to, count, m_pos);
    m_pos += static_cast<std::int64_t>(got);
    return got;
  }
  std::size_t pread(void* to, std::size_t count, std::int64_t offset) override {
    if (offset < 0 || static_cast<std::uint64_t>(offset) >= size()) return 0;
    const std::size_t left = size() - static_cast<std::size_t>(offset);
    return IOMemReader::pread(to, std::min(count, left), offset);
  }
};

}  // namespace mezzotint
