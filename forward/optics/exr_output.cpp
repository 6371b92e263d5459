#include "forward/optics/exr_output.h"

#include <memory>
#include <string_view>
#include <vector>

#include <OpenImageIO/filesystem.h>

#include "forward/base/error.h"
#include "forward/base/file_output.h"

namespace mezzotint {

void write_exr_picture(const OIIO::ImageSpec& spec, std::span<const float> pixels, const std::filesystem::path& path) {
  const std::unique_ptr<OIIO::ImageOutput> file = OIIO::ImageOutput::create("exr");
  if (!file) throw DeviceError("cannot write " + path.string() + ": OpenImageIO has no OpenEXR here");
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput sink(bytes);
  OIIO::Filesystem::IOProxy* const proxy = &sink;
  OIIO::ImageSpec to_memory = spec;
  to_memory.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  if (!file->open("exr", to_memory) || !file->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) || !file->close())
    throw DeviceError("cannot write " + path.string() + ": " + file->geterror());
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace mezzotint
