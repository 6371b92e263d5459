#pragma once

#include <filesystem>
#include <string>

#include "fabrication/projector/dlpc900.h"
#include "fabrication/session/machine_profile.h"

namespace mezzotint {

/// A machine: how it prints, and how its devices are wired.
struct Machine {
  MachineProfile profile;
  Dlpc900Options projector;
  std::string usb;   ///< "BUS:ADDRESS" of the projector; empty: the only one there is
  int display = -1;  ///< number of the projector's display; −1: the one of its size
};

/// A machine profile from a TOML file; keys that are left out keep the defaults, unknown ones are errors.
/// @throws ConfigurationError
[[nodiscard]] Machine read_machine(const std::filesystem::path& path);

}  // namespace mezzotint
