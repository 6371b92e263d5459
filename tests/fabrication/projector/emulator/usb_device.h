#pragma once

#include <memory>

#include "tests/fabrication/projector/emulator/device_model.h"

namespace mezzotint::emulator {

/// An emulated projector on an emulated bus (umockdev), which unmodified libusb finds, opens and talks to. The
/// program has to be linked with umockdev's preload library before all others.
///
/// Not emulated: the pace of USB 1.1 (reports go about ten times as fast), permissions and udev rules, suspend.
class UsbDevice {
public:
  struct Shape {
    std::uint8_t in_endpoint = 0x81, out_endpoint = 0x01;
    bool has_second_interface = true;  ///< not the one to use
    std::uint16_t packet_bytes = 64;
  };
  /// The model outlives it. Its kernel driver, usbhid, is bound.
  explicit UsbDevice(DeviceModel& model) : UsbDevice(model, Shape{}) {}
  UsbDevice(DeviceModel& model, const Shape& shape);
  ~UsbDevice();

  void unplug();
  void plug();
  /// Whether the kernel's driver has the device: before it is opened, and again after it was closed.
  [[nodiscard]] bool kernel_driver_is_bound();

private:
  class Bus;
  std::unique_ptr<Bus> bus_;
};

}  // namespace mezzotint::emulator
