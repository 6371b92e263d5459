#include "experiments/command_line/direction_store.h"

#include <bit>

#include <fmt/format.h>

#include "forward/base/digest.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

std::string digest_of_text(const std::string& text) { return sha256_hex(std::as_bytes(std::span(text))); }

std::string digest_of(const HeightField& relief, const std::string& how) {
  const Grid& grid = relief.grid();
  return digest_of_text(fmt::format("{} {} {} {:a} {:a} {} {}", sha256_hex(std::as_bytes(relief.heights_um())),
                                    grid.columns, grid.rows, grid.pitch_x.um(), grid.pitch_y.um(), relief.periodic(),
                                    how));
}

void round_to_float(DirectionMap& map) {
  for (double& value : map) value = static_cast<double>(static_cast<float>(value));
}

void round_to_float(MapEstimate& estimate) {
  for (DirectionMap* map : {&estimate.mean, &estimate.standard_error, &estimate.half_a, &estimate.half_b,
                            &estimate.low_95, &estimate.high_95}) {
    round_to_float(*map);
  }
}

}  // namespace

DirectionStore::DirectionStore(std::filesystem::path folder, const HeightField& relief, const std::string& how)
    : folder_(std::move(folder)), key_(digest_of(relief, how)) {
  std::error_code failure;
  std::filesystem::create_directories(folder_, failure);
  if (failure) throw DeviceError("cannot make the folder " + folder_.string() + ": " + failure.message());
}

std::filesystem::path DirectionStore::file_of(const DirectionAngles& to_light) const {
  const auto bits = [](Angle angle) { return std::bit_cast<std::uint64_t>(angle.radians()); };
  const std::string name = fmt::format("{} {:x} {:x}", key_, bits(to_light.theta), bits(to_light.phi));
  return folder_ / (digest_of_text(name).substr(0, 32) + ".exr");
}

std::optional<Bsdf> DirectionStore::find(const DirectionAngles& to_light) const {
  const std::filesystem::path file = file_of(to_light);
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return std::nullopt;
  return read_exr(file);
}

void DirectionStore::keep(const Bsdf& bsdf) const { write_exr(bsdf, file_of(bsdf.incidence)); }

Bsdf rounded(Bsdf bsdf) {
  round_to_float(bsdf.reflection);
  round_to_float(bsdf.transmission);
  return bsdf;
}

}  // namespace mezzotint
