#pragma once

#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace mezzotint::benchmark {

/// What a program took from its start to its end.
struct ChildCost {
  double cpu_s = 0.0;  ///< user and system, all threads
  double peak_mb = 0.0;
  int status = -1;
};

inline ChildCost cost_of(int process) {
  ChildCost cost;
  int status = 0;
  rusage usage = {};
  if (::wait4(process, &status, 0, &usage) < 0) throw std::runtime_error("cannot wait for a program");
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  cost.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  cost.peak_mb = static_cast<double>(usage.ru_maxrss) / 1024.0;
  cost.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return cost;
}

/// Runs a program without its output. The peak of memory is at least that of this program, which is to be small.
inline ChildCost run(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", 1, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", 1, 0);
  pid_t process = -1;
  const int problem = ::posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), ::environ);
  posix_spawn_file_actions_destroy(&actions);
  if (problem != 0) throw std::runtime_error("cannot start " + words[0]);
  return cost_of(process);
}

/// Does work that needs much memory in a child, so that this program stays small.
inline void in_a_child(const std::function<void()>& work) {
  std::fflush(stdout);
  const pid_t process = ::fork();
  if (process < 0) throw std::runtime_error("cannot fork");
  if (process == 0) {
    work();
    std::fflush(stdout);
    ::_exit(0);
  }
  if (cost_of(process).status != 0) throw std::runtime_error("a child failed");
}

}  // namespace mezzotint::benchmark
