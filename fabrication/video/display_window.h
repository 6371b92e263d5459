#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fabrication/device/layer_window.h"

namespace mezzotint {

/// A display as the desktop knows it.
struct Display {
  int index = 0;
  std::string name;
  std::size_t columns = 0;
  std::size_t rows = 0;
};

/// @throws LightEngineError LostSync where there is no desktop at all.
[[nodiscard]] std::vector<Display> list_displays();

struct DisplayWindowOptions {
  std::size_t columns = 2560;  ///< the projector's; no other size will do
  std::size_t rows = 1600;
  int display = -1;  ///< of `list_displays`; −1: the only one of that size
};

/// A full-screen window on the projector's display: black, without a pointer, one pixel of the picture a pixel of
/// the display. Gray values go out as R = G = B; a desktop that corrects colours for this display falsifies them.
///
/// Threads  One window at a time, and all of its calls on the thread that opened it.
/// @throws LightEngineError Incompatible where the display, or the window that the desktop grants, has another size
///         (scaling, rotation); LostSync where there is no such display. The message lists what there is.
[[nodiscard]] std::unique_ptr<LayerWindow> open_display_window(const DisplayWindowOptions& options);

}  // namespace mezzotint
