#include "fabrication/session/guardian.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "tests/test_data.h"

namespace mezzotint {
namespace {

using namespace std::chrono_literals;

/// A light as a file: there while it is on.
struct FileLight {
  test::TemporaryFolder folder;
  [[nodiscard]] std::filesystem::path path() const { return folder / "light"; }
  void on() const { std::ofstream(path()) << "on"; }
  [[nodiscard]] bool is_on() const { return std::filesystem::exists(path()); }
  [[nodiscard]] std::function<bool()> put_off() const {
    return [path = path()] { return std::filesystem::remove(path); };
  }
  [[nodiscard]] bool goes_off() const {
    for (int i = 0; i < 500 && is_on(); ++i) std::this_thread::sleep_for(10ms);
    return !is_on();
  }
};

// A process that lights for `longest` and then does `act`; its wait status.
int light_in_child(const FileLight& light, Clock::Duration longest, const std::function<void()>& act) {
  const pid_t child = ::fork();
  if (child == 0) {
    Guardian guardian(light.put_off());
    light.on();
    guardian.expect_light(longest);
    act();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

TEST(Guardian, PutsTheLightOffBehindAKilledProcess) {
  const FileLight light;
  light_in_child(light, 60s, [] { ::raise(SIGKILL); });
  EXPECT_TRUE(light.goes_off());
}

TEST(Guardian, PutsTheLightOffBehindACrash) {
  const FileLight light;
  light_in_child(light, 60s, [] {
    ::signal(SIGABRT, SIG_DFL);
    std::abort();
  });
  EXPECT_TRUE(light.goes_off());
}

TEST(Guardian, KillsAProcessThatHangsWithTheLightOn) {
  const FileLight light;
  const auto begin = std::chrono::steady_clock::now();
  const int status = light_in_child(light, 200ms, [] { std::this_thread::sleep_for(60s); });
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  EXPECT_TRUE(light.goes_off());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 20s);
}

TEST(Guardian, KillsAProcessThatWasStoppedWithTheLightOn) {
  const FileLight light;
  light_in_child(light, 200ms, [] { ::raise(SIGSTOP); });
  EXPECT_TRUE(light.goes_off());
}

TEST(Guardian, LeavesAProcessAloneThatKeepsItsWord) {
  const FileLight light;
  {
    Guardian guardian(light.put_off());
    for (int i = 0; i < 3; ++i) {
      guardian.expect_light(200ms);
      guardian.expect_dark();
    }
    light.on();  // what the guardian would remove if it acted
    std::this_thread::sleep_for(300ms);
  }
  EXPECT_TRUE(light.is_on());
}

TEST(Guardian, TriesOnceMoreWhereTheLightWasLeftOn) {
  const FileLight light;
  {
    Guardian guardian(light.put_off());
    light.on();
    guardian.expect_light(60s);
  }
  EXPECT_FALSE(light.is_on());
}

}  // namespace
}  // namespace mezzotint
