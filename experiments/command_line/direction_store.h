#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "forward/optics/bsdf.h"
#include "forward/surface/height_field.h"

namespace mezzotint {

/// The BSDFs of single directions that a table is built of, kept in a folder, so that a run that was stopped goes on.
///
/// Files    one EXR a direction, named by a digest of the relief, of how it was computed and of the direction to the
///          last bit: what belongs to another run is never found, and stays where it is.
/// Bits     a map read back is rounded to float. `rounded` does the same to a fresh one, so that a run that goes on
///          and one that never stopped agree.
class DirectionStore {
public:
  /// @param how  everything beside the relief and the direction that decides the result.
  DirectionStore(std::filesystem::path folder, const HeightField& relief, const std::string& how);

  /// @throws FileError for a file of that name that cannot be read as a BSDF.
  [[nodiscard]] std::optional<Bsdf> find(const DirectionAngles& to_light) const;
  /// @throws DeviceError where it cannot be written.
  void keep(const Bsdf& bsdf) const;

private:
  [[nodiscard]] std::filesystem::path file_of(const DirectionAngles& to_light) const;

  std::filesystem::path folder_;
  std::string key_;
};

/// With all maps as a file would give them back.
[[nodiscard]] Bsdf rounded(Bsdf bsdf);

}  // namespace mezzotint
