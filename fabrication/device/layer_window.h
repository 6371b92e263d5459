#pragma once

#include "fabrication/device/light_engine.h"

namespace mezzotint {

/// A picture, pixel by pixel, on the display that the projector is.
///
/// Errors   LightEngineError: Incompatible where the display has another size, LostSync where it is gone;
///          InvalidInput for a picture of another size.
class LayerWindow {
public:
  virtual ~LayerWindow() = default;
  [[nodiscard]] virtual std::size_t columns() const = 0;
  [[nodiscard]] virtual std::size_t rows() const = 0;
  /// Returns once the display has been given the picture; the projector shows it some frames later.
  virtual void show(const ShownPicture& picture) = 0;
  virtual void blank() = 0;
};

}  // namespace mezzotint
