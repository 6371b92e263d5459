#pragma once

#include <memory>
#include <string>

#include "fabrication/projector/report_transport.h"

namespace mezzotint::dlpc900 {

/// Which device on the bus.
struct UsbPlace {
  std::uint16_t vendor = 0x0451;
  std::uint16_t product = 0xc900;
  std::string place;  ///< "BUS:ADDRESS" as lsusb prints them ("001:004"); empty: the only one there is
};

/// A transport over libusb: interface 0, whose interrupt endpoints are looked up in the device's descriptors. The
/// kernel's HID driver is detached while it lives and given back afterwards. A stalled endpoint is cleared and the
/// transfer tried again, once.
/// @throws LightEngineError Disconnected where there is no such device or it may not be opened (udev rule), or several
///         are there and `place` names none; Incompatible where its descriptors are not those of such a device.
[[nodiscard]] std::unique_ptr<ReportTransport> open_usb(const UsbPlace& place = {});

}  // namespace mezzotint::dlpc900
