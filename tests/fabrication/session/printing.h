#pragma once

#include <unistd.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "fabrication/session/print_session.h"
#include "tests/fabrication/session/fake_machine.h"

namespace mezzotint::test {

/// A folder in memory, where there is one: the journals of hundreds of prints need no disk.
class JournalFolder {
public:
  JournalFolder() {
    const std::string root = std::filesystem::exists("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path();
    std::string name = root + "/mezzotint-test-XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~JournalFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  JournalFolder(const JournalFolder&) = delete;
  JournalFolder& operator=(const JournalFolder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
  std::filesystem::path path_;
};

/// How one attempt at a print ended.
struct Attempt {
  std::optional<SessionEnd> end;
  std::string error;
  bool refused = false;  ///< InvalidInput: nothing moved
  bool said_light_may_be_on = false;
  bool said_away = false;
};

inline Attempt attempt(World& world, const LayerSource& job, const MachineProfile& machine, SessionOptions options,
                       SessionControl& control) {
  Attempt result;
  try {
    FakeLight light(world, job.frame.columns, job.frame.rows);
    FakeStage stage(world);
    PrintSession session(job, machine, light, stage, world.clock, control, options);
    result.end = session.run();
  } catch (const PrintError& error) {
    result.error = error.what();
    result.said_light_may_be_on = !error.light_is_off();
    result.said_away = error.platform_is_away();
  } catch (const InvalidInput& error) {
    result.error = error.what();
    result.refused = true;
  } catch (const std::exception& error) {
    result.error = error.what();
  }
  return result;
}

/// What the user does after a fault: cuts and restores the power, plugs the cables in.
inline void mend(World& world) {
  world.light_reachable = world.stage_reachable = true;
  world.put_light(false);
  world.violations.clear();
}

}  // namespace mezzotint::test
