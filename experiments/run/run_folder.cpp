#include "experiments/run/run_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>
#include <cerrno>
#include <fstream>

#include "forward/base/digest.h"
#include "forward/base/error.h"
#include "forward/base/file_input.h"
#include "forward/base/file_output.h"

namespace mezzotint {

namespace fs = std::filesystem;

namespace {

constexpr const char* state_name = "run.json";

bool is_empty_or_missing(const fs::path& folder) { return !fs::exists(folder) || fs::is_empty(folder); }

// "runs/brushed/" and "runs/brushed" are one folder.
fs::path without_trailing_slash(const fs::path& folder) {
  return folder.has_filename() ? folder : folder.parent_path();
}

// The lock ends with the process however that ends, and leaves no file. Where a file system knows no locks, there
// is none.
std::shared_ptr<void> lock(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return nullptr;
  std::shared_ptr<void> result(nullptr, [descriptor](void*) { ::close(descriptor); });
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    throw DeviceError("another run is at work in " + folder.string() + "; wait for it, or name another folder");
  }
  return result;
}

// A run that was killed may have left temporaries of half-written files.
void remove_leftovers(const fs::path& folder) {
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && name.starts_with('.') && name.find(".part") != std::string::npos) {
      fs::remove(entry.path());
    }
  }
}

void move_aside(const fs::path& folder) {
  const fs::path previous = folder.string() + ".previous";
  require(
      is_empty_or_missing(previous) || fs::exists(previous / state_name),
      previous.string() + " holds something that is no run of ours, and the earlier run would go there; move it away");
  fs::remove_all(previous);
  fs::rename(folder, previous);
}

nlohmann::ordered_json read_state(const fs::path& path) {
  const auto bytes = read_file(path);
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  auto state = nlohmann::ordered_json::parse(text, text + bytes.size(), nullptr, false);
  const bool is_state = state.is_object() && state.contains("experiment") && state["experiment"].is_string() &&
                        state.contains("stages") && state["stages"].is_object();
  if (!is_state) throw FileError(path, "", "is no record of a run; start anew without --resume");
  return state;
}

}  // namespace

std::string file_digest(const fs::path& path) { return sha256_hex(read_file(path)); }

RunFolder::RunFolder(fs::path folder, std::string experiment_digest, bool resume)
    : folder_(without_trailing_slash(std::move(folder))) {
  const fs::path state_path = folder_ / state_name;
  const bool has_run = fs::exists(state_path);
  require(has_run || is_empty_or_missing(folder_),
          folder_.string() + " holds something that is no run of ours; name another folder with --out");
  if (has_run) lock_ = lock(folder_);
  if (has_run && resume) {
    state_ = read_state(state_path);
    require(state_["experiment"] == experiment_digest,
            folder_.string() +
                " holds a run of another experiment, of other settings or of another version; run without "
                "--resume to start anew (the old run is kept as " +
                folder_.filename().string() + ".previous)");
    remove_leftovers(folder_);
    return;
  }
  try {
    if (has_run) move_aside(folder_);
    fs::create_directories(folder_);
  } catch (const fs::filesystem_error& error) {
    throw DeviceError("cannot make the folder " + folder_.string() + ": " + error.code().message());
  }
  lock_ = lock(folder_);
  state_ = {{"experiment", experiment_digest}, {"stages", nlohmann::ordered_json::object()}};
  save();
}

bool RunFolder::is_finished(const std::string& stage) const {
  const auto& stages = state_.at("stages");
  const auto found = stages.find(stage);
  if (found == stages.end()) return false;
  for (const auto& [file, digest] : found->items()) {
    if (!fs::exists(folder_ / file) || file_digest(folder_ / file) != digest) return false;
  }
  return true;
}

void RunFolder::finish(const std::string& stage, const std::vector<std::string>& outputs) {
  nlohmann::ordered_json digests = nlohmann::ordered_json::object();
  for (const auto& file : outputs) digests[file] = file_digest(folder_ / file);
  state_["stages"][stage] = std::move(digests);
  save();
}

void RunFolder::save() const { write_file(folder_ / state_name, state_.dump(2) + "\n"); }

}  // namespace mezzotint
