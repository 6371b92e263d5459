#pragma once

#include "fabrication/device/layer_window.h"
#include "tests/fabrication/projector/emulator/device_model.h"

namespace mezzotint {

/// A window whose pixels are the emulated projector's video.
class EmulatedWindow final : public LayerWindow {
public:
  EmulatedWindow(emulator::DeviceModel& device, std::size_t columns, std::size_t rows)
      : device_(device), columns_(columns), rows_(rows) {}
  [[nodiscard]] std::size_t columns() const override { return columns_; }
  [[nodiscard]] std::size_t rows() const override { return rows_; }
  void show(const ShownPicture& picture) override { device_.show_video({picture.gray.begin(), picture.gray.end()}); }
  void blank() override { device_.show_video(emulator::Bytes(columns_ * rows_, 0)); }

private:
  emulator::DeviceModel& device_;
  std::size_t columns_, rows_;
};

}  // namespace mezzotint
