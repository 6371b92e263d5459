#pragma once

#include <sys/resource.h>
#include <sys/types.h>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace mezzotint::test {

/// How the program ended, and what it said.
struct Ending {
  int status = 0;  ///< exit status; 128 + its number where a signal ended the program, as a shell counts
  std::string out;
  std::string err;
};

/// Under what conditions the program runs.
struct Conditions {
  const char* standard_output = nullptr;      ///< a device in place of the file that captures it
  rlim_t largest_file_bytes = RLIM_INFINITY;  ///< writing beyond it fails: a full disk without being root
};

/// `mezzotint` while it runs in a working folder.
class RunningProgram {
public:
  RunningProgram(const std::filesystem::path& working_folder, const std::vector<std::string>& arguments,
                 const Conditions& conditions = {});
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  /// Waits until a file is there; false where the program ended first.
  [[nodiscard]] bool wait_for(const std::filesystem::path& file);
  void send(int signal) const;
  [[nodiscard]] Ending wait();

private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  using File = std::unique_ptr<std::FILE, Close>;
  [[nodiscard]] bool has_ended();

  // Unnamed files: nothing of them shows in the working folder, and no pipe can fill up.
  File out_{std::tmpfile()};
  File err_{std::tmpfile()};
  pid_t process_ = -1;
  bool ended_ = false;
  int wait_status_ = 0;
};

}  // namespace mezzotint::test
