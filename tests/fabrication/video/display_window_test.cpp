#include "fabrication/video/display_window.h"

#include <gtest/gtest.h>

#ifdef MEZZOTINT_XVFB

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

namespace mezzotint {
namespace {

constexpr std::size_t columns = 2560, rows = 1600;

/// An X server without a screen, of this test's own.
class VirtualScreen {
public:
  VirtualScreen() {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
    process_ = ::fork();
    if (process_ == 0) {
      const std::string number = std::to_string(ends[1]);
      ::execl(MEZZOTINT_XVFB, "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "2560x1600x24", "-nolisten", "tcp",
              "-noreset", nullptr);
      ::_exit(127);
    }
    ::close(ends[1]);
    char digit = 0;
    while (::read(ends[0], &digit, 1) == 1 && digit != '\n') name_ += digit;
    ::close(ends[0]);
    if (name_.empty()) return;
    name_ = ":" + name_;
    ::setenv("DISPLAY", name_.c_str(), 1);
    ::setenv("SDL_VIDEODRIVER", "x11", 1);
  }
  ~VirtualScreen() {
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
  }
  [[nodiscard]] bool runs() const { return !name_.empty(); }

  /// Red, green and blue of every pixel of the whole screen, row 0 on top.
  [[nodiscard]] std::vector<std::uint32_t> screenshot() const {
    ::Display* display = XOpenDisplay(name_.c_str());
    if (display == nullptr) return {};
    XImage* image = XGetImage(display, DefaultRootWindow(display), 0, 0, columns, rows, AllPlanes, ZPixmap);
    std::vector<std::uint32_t> pixels;
    for (int y = 0; y < static_cast<int>(rows); ++y) {
      for (int x = 0; x < static_cast<int>(columns); ++x) {
        pixels.push_back(static_cast<std::uint32_t>(XGetPixel(image, x, y)) & 0xffffffU);
      }
    }
    XDestroyImage(image);
    XCloseDisplay(display);
    return pixels;
  }

private:
  pid_t process_ = -1;
  std::string name_;
};

class DisplayWindowTest : public testing::Test {
protected:
  VirtualScreen screen;
  void SetUp() override {
    if (!screen.runs()) GTEST_SKIP() << "Xvfb does not start here";
  }
};

TEST_F(DisplayWindowTest, ShowsALayerPixelByPixel) {
  const auto window = open_display_window({columns, rows});
  EXPECT_EQ(window->columns(), columns);
  EXPECT_EQ(window->rows(), rows);
  std::vector<std::uint8_t> gray(columns * rows);
  std::uint32_t state = 3;
  for (auto& value : gray) value = static_cast<std::uint8_t>((state = state * 1664525U + 1013904223U) >> 24);
  window->show({columns, rows, gray});
  const auto seen = screen.screenshot();
  ASSERT_EQ(seen.size(), gray.size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < gray.size(); ++i) wrong += seen[i] != 0x010101U * gray[i];
  EXPECT_EQ(wrong, 0U);
  window->blank();
  EXPECT_EQ(screen.screenshot(), std::vector<std::uint32_t>(gray.size(), 0));
}

TEST_F(DisplayWindowTest, RefusesADisplayOfAnotherSize) {
  for (const int display : {-1, 0}) {
    try {
      static_cast<void>(open_display_window({1920, 1080, display}));
      FAIL();
    } catch (const LightEngineError& error) {
      EXPECT_EQ(error.fault(), LightFault::Incompatible);
      EXPECT_NE(std::string(error.what()).find("2560 x 1600"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(static_cast<void>(open_display_window({columns, rows, 7})), LightEngineError);
}

TEST_F(DisplayWindowTest, RefusesAPictureOfAnotherSize) {
  const auto window = open_display_window({columns, rows});
  const std::vector<std::uint8_t> gray(columns * rows);
  EXPECT_THROW(window->show({columns, rows - 1, gray}), InvalidInput);
}

TEST_F(DisplayWindowTest, ListsDisplays) {
  const auto displays = list_displays();
  ASSERT_EQ(displays.size(), 1U);
  EXPECT_EQ(displays[0].columns, columns);
  EXPECT_EQ(displays[0].rows, rows);
}

}  // namespace
}  // namespace mezzotint

#else

TEST(DisplayWindow, ShowsALayerPixelByPixel) { GTEST_SKIP() << "Xvfb (Debian: xvfb) or Xlib is missing"; }

#endif
