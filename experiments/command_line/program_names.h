#pragma once

namespace mezzotint {

/// Beside the program that is started.
inline constexpr const char* program_with_all_commands = "mezzotint-all";

}  // namespace mezzotint
