#include "fabrication/projector/usb_transport.h"

#include <fmt/format.h>
#include <libusb.h>

#include <algorithm>

#include "fabrication/device/light_engine.h"

namespace mezzotint::dlpc900 {
namespace {

constexpr int interface_number = 0;

template <auto Free>
struct Freed {
  template <typename T>
  void operator()(T* pointer) const {
    Free(pointer);
  }
};
using Context = std::unique_ptr<libusb_context, Freed<libusb_exit>>;
using Handle = std::unique_ptr<libusb_device_handle, Freed<libusb_close>>;
using Device = std::unique_ptr<libusb_device, Freed<libusb_unref_device>>;
using Configuration = std::unique_ptr<libusb_config_descriptor, Freed<libusb_free_config_descriptor>>;

LightEngineError usb_error(LightFault fault, const std::string& doing, int code) {
  return {fault,
          fmt::format("{}: {} ({})", doing, libusb_strerror(static_cast<libusb_error>(code)), libusb_error_name(code))};
}

LightFault fault_of(int code) {
  switch (code) {
    case LIBUSB_ERROR_TIMEOUT:
      return LightFault::Timeout;
    case LIBUSB_ERROR_PIPE:
    case LIBUSB_ERROR_OVERFLOW:
      return LightFault::Protocol;
    default:
      return LightFault::Disconnected;  // NO_DEVICE, and IO, which is how a pulled cable looks at first
  }
}

std::string place_of(libusb_device* device) {
  return fmt::format("{:03}:{:03}", libusb_get_bus_number(device), libusb_get_device_address(device));
}

Context make_context() {
  libusb_context* context = nullptr;
  if (const int code = libusb_init(&context); code != 0) {
    throw usb_error(LightFault::Disconnected, "USB cannot be used", code);
  }
  return Context(context);
}

std::vector<Device> matching_devices(libusb_context* context, const UsbPlace& wanted) {
  libusb_device** list = nullptr;
  const auto count = libusb_get_device_list(context, &list);
  if (count < 0) throw usb_error(LightFault::Disconnected, "USB devices cannot be listed", static_cast<int>(count));
  std::vector<Device> found;
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor descriptor{};
    const bool matches = libusb_get_device_descriptor(list[i], &descriptor) == 0 &&
                         descriptor.idVendor == wanted.vendor && descriptor.idProduct == wanted.product;
    if (matches && (wanted.place.empty() || place_of(list[i]) == wanted.place)) {
      found.emplace_back(libusb_ref_device(list[i]));
    }
  }
  libusb_free_device_list(list, 1);
  return found;
}

Device find_device(libusb_context* context, const UsbPlace& wanted) {
  auto found = matching_devices(context, wanted);
  const std::string name = fmt::format("USB device {:04x}:{:04x}", wanted.vendor, wanted.product);
  if (found.empty()) {
    throw LightEngineError(LightFault::Disconnected, fmt::format("no projector ({}{}{}) is connected", name,
                                                                 wanted.place.empty() ? "" : " at ", wanted.place));
  }
  if (found.size() > 1) {
    std::string places;
    for (const auto& device : found) places += " " + place_of(device.get());
    throw LightEngineError(LightFault::Disconnected, fmt::format("{} projectors ({}) are connected; say which one:{}",
                                                                 found.size(), name, places));
  }
  return std::move(found.front());
}

struct Endpoints {
  unsigned char in = 0, out = 0;
};

Endpoints find_endpoints(libusb_device* device) {
  libusb_config_descriptor* raw = nullptr;
  if (const int code = libusb_get_active_config_descriptor(device, &raw); code != 0) {
    throw usb_error(LightFault::Incompatible, "the projector's descriptors cannot be read", code);
  }
  const Configuration configuration(raw);
  Endpoints found;
  for (int i = 0; i < configuration->bNumInterfaces; ++i) {
    const auto& interface = configuration->interface[i];
    if (interface.num_altsetting < 1 || interface.altsetting[0].bInterfaceNumber != interface_number) continue;
    for (int e = 0; e < interface.altsetting[0].bNumEndpoints; ++e) {
      const auto& endpoint = interface.altsetting[0].endpoint[e];
      const bool fits = (endpoint.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK) == LIBUSB_TRANSFER_TYPE_INTERRUPT &&
                        endpoint.wMaxPacketSize == report_bytes;
      if (!fits) continue;
      ((endpoint.bEndpointAddress & LIBUSB_ENDPOINT_IN) != 0 ? found.in : found.out) = endpoint.bEndpointAddress;
    }
  }
  if (found.in == 0 || found.out == 0) {
    throw LightEngineError(LightFault::Incompatible,
                           "the projector's interface 0 lacks a pair of interrupt endpoints of 64 bytes");
  }
  return found;
}

unsigned milliseconds_of(Clock::Duration timeout) {
  const auto count = std::chrono::ceil<std::chrono::milliseconds>(timeout).count();
  return static_cast<unsigned>(std::clamp<std::int64_t>(count, 1, 60'000));  // 0 would wait for ever
}

class UsbTransport final : public ReportTransport {
public:
  explicit UsbTransport(const UsbPlace& wanted) : context_(make_context()) {
    const Device device = find_device(context_.get(), wanted);
    libusb_device_handle* handle = nullptr;
    if (const int code = libusb_open(device.get(), &handle); code != 0) {
      const std::string hint = code == LIBUSB_ERROR_ACCESS ? " (is the udev rule installed?)" : "";
      throw usb_error(LightFault::Disconnected,
                      "the projector at " + place_of(device.get()) + " cannot be opened" + hint, code);
    }
    handle_.reset(handle);
    endpoints_ = find_endpoints(device.get());
    libusb_set_auto_detach_kernel_driver(handle, 1);  // where that is not known, claiming says what is wrong
    if (const int code = libusb_claim_interface(handle, interface_number); code != 0) {
      throw usb_error(LightFault::Disconnected, "the projector is held by another program", code);
    }
    claimed_ = true;
  }
  ~UsbTransport() override {
    if (claimed_) libusb_release_interface(handle_.get(), interface_number);  // the kernel's driver comes back
  }

  void send(const Report& report, Clock::Duration timeout) override {
    Report copy = report;
    const int sent = transfer(endpoints_.out, copy.data(), timeout);
    if (sent == static_cast<int>(report_bytes)) return;
    throw LightEngineError(LightFault::Timeout, fmt::format("the projector took {} of 64 bytes in time", sent));
  }

  std::optional<ReceivedReport> receive(Clock::Duration timeout) override {
    ReceivedReport report;
    const int received = transfer(endpoints_.in, report.bytes.data(), timeout);
    if (received < 0) return {};
    report.size = static_cast<std::size_t>(received);
    return report;
  }

private:
  /// Bytes that went over; −1 where none did in time.
  int transfer(unsigned char endpoint, unsigned char* bytes, Clock::Duration timeout) {
    for (int attempt = 1;; ++attempt) {
      int moved = 0;
      const int code = libusb_interrupt_transfer(handle_.get(), endpoint, bytes, static_cast<int>(report_bytes), &moved,
                                                 milliseconds_of(timeout));
      if (code == 0) return moved;
      if (code == LIBUSB_ERROR_TIMEOUT) return moved > 0 ? moved : -1;
      if (code == LIBUSB_ERROR_PIPE && attempt == 1 && libusb_clear_halt(handle_.get(), endpoint) == 0) continue;
      throw usb_error(fault_of(code),
                      (endpoint & LIBUSB_ENDPOINT_IN) != 0 ? "no report comes from the projector"
                                                           : "no report reaches the projector",
                      code);
    }
  }

  Context context_;
  Handle handle_;
  Endpoints endpoints_;
  bool claimed_ = false;
};

}  // namespace

std::unique_ptr<ReportTransport> open_usb(const UsbPlace& place) { return std::make_unique<UsbTransport>(place); }

}  // namespace mezzotint::dlpc900
