#include "tests/loop/program.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

namespace mezzotint::test {

namespace {

std::string text_of(std::FILE* file) {
  std::rewind(file);
  std::string text;
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) text += static_cast<char>(c);
  return text;
}

// In the child, between fork and exec: plain system calls only.
[[noreturn]] void become_the_program(const char* folder, char* const* arguments, int out, int err,
                                     const Conditions& conditions) {
  if (conditions.standard_output != nullptr) out = ::open(conditions.standard_output, O_WRONLY);
  const rlimit limit{conditions.largest_file_bytes, conditions.largest_file_bytes};
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, SIG_IGN);
  if (::chdir(folder) != 0 || ::dup2(out, STDOUT_FILENO) < 0 || ::dup2(err, STDERR_FILENO) < 0) ::_exit(126);
  ::execv(arguments[0], arguments);
  ::_exit(127);
}

}  // namespace

RunningProgram::RunningProgram(const std::filesystem::path& working_folder, const std::vector<std::string>& arguments,
                               const Conditions& conditions) {
  std::vector<std::string> words = {MEZZOTINT_PROGRAM_PATH};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (auto& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  process_ = ::fork();
  if (process_ < 0) throw std::runtime_error("cannot start a process");
  if (process_ == 0) {
    become_the_program(working_folder.c_str(), pointers.data(), ::fileno(out_.get()), ::fileno(err_.get()), conditions);
  }
}

RunningProgram::~RunningProgram() {
  if (ended_) return;
  send(SIGKILL);
  ::waitpid(process_, &wait_status_, 0);
}

bool RunningProgram::has_ended() {
  if (!ended_) ended_ = ::waitpid(process_, &wait_status_, WNOHANG) == process_;
  return ended_;
}

bool RunningProgram::wait_for(const std::filesystem::path& file) {
  while (!std::filesystem::exists(file)) {
    if (has_ended()) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return !has_ended();
}

void RunningProgram::send(int signal) const { ::kill(process_, signal); }

Ending RunningProgram::wait() {
  if (!ended_) ::waitpid(process_, &wait_status_, 0);
  ended_ = true;
  const int status = WIFEXITED(wait_status_) ? WEXITSTATUS(wait_status_) : 128 + WTERMSIG(wait_status_);
  return {status, text_of(out_.get()), text_of(err_.get())};
}

}  // namespace mezzotint::test
