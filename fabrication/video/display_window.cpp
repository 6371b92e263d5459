#include "fabrication/video/display_window.h"

#include <SDL.h>
#include <fmt/format.h>

#include <algorithm>

namespace mezzotint {
namespace {

LightEngineError video_error(LightFault fault, const std::string& what) {
  return {fault, fmt::format("{}: {}", what, SDL_GetError())};
}

/// SDL's video, while someone needs it.
class Video {
public:
  Video() {
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");            // Ctrl-C belongs to the program
    SDL_SetHint(SDL_HINT_VIDEO_MINIMIZE_ON_FOCUS_LOSS, "0");  // the projector shows on while someone types elsewhere
    SDL_SetHint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "1");
    if (SDL_InitSubSystem(SDL_INIT_VIDEO) != 0) throw video_error(LightFault::LostSync, "no desktop to show layers on");
  }
  ~Video() { SDL_QuitSubSystem(SDL_INIT_VIDEO); }
  Video(const Video&) = delete;
  Video& operator=(const Video&) = delete;
};

std::vector<Display> displays_of(const Video&) {
  std::vector<Display> list;
  for (int index = 0; index < SDL_GetNumVideoDisplays(); ++index) {
    SDL_DisplayMode mode{};
    if (SDL_GetDesktopDisplayMode(index, &mode) != 0) continue;
    const char* name = SDL_GetDisplayName(index);
    list.push_back(
        {index, name != nullptr ? name : "", static_cast<std::size_t>(mode.w), static_cast<std::size_t>(mode.h)});
  }
  return list;
}

std::string listed(const std::vector<Display>& displays) {
  std::string text;
  for (const auto& display : displays) {
    text += fmt::format("\n  {}: {} x {} {}", display.index, display.columns, display.rows, display.name);
  }
  return text;
}

Display choose_display(const std::vector<Display>& displays, const DisplayWindowOptions& options) {
  const auto fits = [&](const Display& display) {
    return display.columns == options.columns && display.rows == options.rows;
  };
  const std::string size = fmt::format("{} x {}", options.columns, options.rows);
  if (options.display < 0) {
    const auto count = std::count_if(displays.begin(), displays.end(), fits);
    if (count == 1) return *std::find_if(displays.begin(), displays.end(), fits);
    throw LightEngineError(LightFault::Incompatible,
                           fmt::format("{} displays have the projector's {} pixels; name the one to use. There are:{}",
                                       count == 0 ? "no" : "several", size, listed(displays)));
  }
  const auto chosen = std::find_if(displays.begin(), displays.end(),
                                   [&](const Display& display) { return display.index == options.display; });
  if (chosen == displays.end()) {
    throw LightEngineError(LightFault::LostSync,
                           fmt::format("there is no display {}. There are:{}", options.display, listed(displays)));
  }
  if (!fits(*chosen)) {
    throw LightEngineError(
        LightFault::Incompatible,
        fmt::format("display {} has {} x {} pixels, and the projector {}: a scaled layer is no layer", chosen->index,
                    chosen->columns, chosen->rows, size));
  }
  return *chosen;
}

class DisplayWindow final : public LayerWindow {
public:
  explicit DisplayWindow(const DisplayWindowOptions& options) : columns_(options.columns), rows_(options.rows) {
    const Display display = choose_display(displays_of(video_), options);
    const int place = static_cast<int>(SDL_WINDOWPOS_UNDEFINED_DISPLAY(display.index));
    window_.reset(SDL_CreateWindow("Mezzotint layer", place, place, static_cast<int>(columns_), static_cast<int>(rows_),
                                   SDL_WINDOW_FULLSCREEN_DESKTOP | SDL_WINDOW_BORDERLESS | SDL_WINDOW_ALWAYS_ON_TOP));
    if (!window_) throw video_error(LightFault::LostSync, "no window on the projector's display");
    SDL_ShowCursor(SDL_DISABLE);
    settle();
    blank();
  }

  [[nodiscard]] std::size_t columns() const override { return columns_; }
  [[nodiscard]] std::size_t rows() const override { return rows_; }

  void show(const ShownPicture& picture) override {
    require(picture.columns == columns_ && picture.rows == rows_ && picture.gray.size() == columns_ * rows_,
            fmt::format("a layer on this display has {} x {} pixels, not {} x {}", columns_, rows_, picture.columns,
                        picture.rows));
    draw([&](std::size_t row, std::size_t column) { return picture.gray[row * columns_ + column]; });
  }
  void blank() override {
    draw([](std::size_t, std::size_t) { return std::uint8_t{0}; });
  }

private:
  struct Destroy {
    void operator()(SDL_Window* window) const { SDL_DestroyWindow(window); }
  };

  /// The desktop may take some events to give the window its size.
  void settle() {
    for (int i = 0; i < 50 && !surface_fits(); ++i) {
      SDL_PumpEvents();
      SDL_Delay(10);
    }
  }
  [[nodiscard]] bool surface_fits() {
    const SDL_Surface* surface = SDL_GetWindowSurface(window_.get());
    return surface != nullptr && surface->w == static_cast<int>(columns_) && surface->h == static_cast<int>(rows_);
  }

  template <typename Gray>
  void draw(const Gray& gray) {
    SDL_PumpEvents();
    SDL_FlushEvents(SDL_FIRSTEVENT, SDL_LASTEVENT);
    SDL_Surface* surface = SDL_GetWindowSurface(window_.get());
    if (surface == nullptr) throw video_error(LightFault::LostSync, "the projector's display is gone");
    if (!surface_fits()) {
      throw LightEngineError(LightFault::Incompatible,
                             fmt::format("the desktop gives the window {} x {} pixels and not {} x {}; is the display "
                                         "scaled or turned?",
                                         surface->w, surface->h, columns_, rows_));
    }
    if (surface->format->BytesPerPixel != 4) {
      throw LightEngineError(LightFault::Incompatible, "the projector's display has not 24 bits a pixel");
    }
    if (SDL_MUSTLOCK(surface)) SDL_LockSurface(surface);
    for (std::size_t row = 0; row < rows_; ++row) {
      auto* pixels = reinterpret_cast<std::uint32_t*>(static_cast<std::uint8_t*>(surface->pixels) +
                                                      row * static_cast<std::size_t>(surface->pitch));
      for (std::size_t column = 0; column < columns_; ++column) {
        const std::uint8_t value = gray(row, column);
        pixels[column] = SDL_MapRGB(surface->format, value, value, value);
      }
    }
    if (SDL_MUSTLOCK(surface)) SDL_UnlockSurface(surface);
    if (SDL_UpdateWindowSurface(window_.get()) != 0)
      throw video_error(LightFault::LostSync, "the projector's display is gone");
  }

  Video video_;
  std::size_t columns_, rows_;
  std::unique_ptr<SDL_Window, Destroy> window_;
};

}  // namespace

std::vector<Display> list_displays() { return displays_of(Video{}); }

std::unique_ptr<LayerWindow> open_display_window(const DisplayWindowOptions& options) {
  require(options.columns >= 1 && options.columns <= 16384 && options.rows >= 1 && options.rows <= 16384,
          "a projector's display has 1 to 16384 columns and rows");
  return std::make_unique<DisplayWindow>(options);
}

}  // namespace mezzotint
