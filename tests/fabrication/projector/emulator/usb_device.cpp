#include "tests/fabrication/projector/emulator/usb_device.h"

#include <sys/ioctl.h>
// In this order: usbdevice_fs.h uses macros of ioctl.h.
#include <linux/usbdevice_fs.h>
#include <umockdev.h>

#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

namespace mezzotint::emulator {
namespace {

constexpr auto empty_reap_hold = std::chrono::milliseconds(2);
constexpr const char* node = "/dev/bus/usb/001/004";
constexpr const char* system_path = "/sys/devices/usb1/1-2";

/// A reference to one of umockdev's pieces of the client's memory.
struct Unref {
  void operator()(UMockdevIoctlData* data) const { g_object_unref(data); }
};
using Data = std::unique_ptr<UMockdevIoctlData, Unref>;

Data resolve(UMockdevIoctlData* data, std::size_t offset, std::size_t bytes) {
  return Data(umockdev_ioctl_data_resolve(data, offset, bytes, nullptr));
}

void complete(UMockdevIoctlClient* client, int error) {
  umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
}

Bytes descriptors(const UsbDevice::Shape& shape) {
  Bytes bytes = {18, 1, 0x10, 0x01, 0, 0, 0, 64, 0x51, 0x04, 0x00, 0xc9, 0x00, 0x01, 1, 2, 0, 1};
  const auto packet = static_cast<std::uint8_t>(shape.packet_bytes);
  const auto interface = [&](std::uint8_t number, std::uint8_t in, std::uint8_t out) {
    const Bytes parts = {9, 4,    number, 0,    2,      3, 0,    0,  0,                         // interface: HID
                         9, 0x21, 0x11,   0x01, 0,      1, 0x22, 34, 0,                         // its HID descriptor
                         7, 5,    in,     3,    packet, 0, 1,    7,  5, out, 3, packet, 0, 1};  // interrupt endpoints
    return parts;
  };
  Bytes interfaces = interface(0, shape.in_endpoint, shape.out_endpoint);
  if (shape.has_second_interface) {
    const Bytes second = interface(1, 0x8f, 0x0f);
    interfaces.insert(interfaces.end(), second.begin(), second.end());
  }
  const auto total = static_cast<std::uint8_t>(9 + interfaces.size());
  for (const int byte : {9, 2, int{total}, 0, shape.has_second_interface ? 2 : 1, 1, 0, 0x80, 50}) {
    bytes.push_back(static_cast<std::uint8_t>(byte));
  }
  bytes.insert(bytes.end(), interfaces.begin(), interfaces.end());
  return bytes;
}

std::string hex(const Bytes& bytes) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  for (const auto byte : bytes) text += {digits[byte / 16], digits[byte % 16]};
  return text;
}

std::string usb_entry(const std::string& path, const std::string& number, const std::string& speed,
                      const std::string& descriptor) {
  return "P: " + path + "\nN: bus/usb/001/00" + number +
         "\nE: SUBSYSTEM=usb\nE: DRIVER=usb\nE: BUSNUM=001\nE: DEVNUM=00" + number +
         "\nE: DEVNAME=/dev/bus/usb/001/00" + number +
         "\nE: DEVTYPE=usb_device\nA: bConfigurationValue=1\\n\nA: busnum=1\\n\n" + "A: devnum=" + number +
         "\\n\nA: speed=" + speed + "\\n\nH: descriptors=" + descriptor + "\n";
}

const char* const root_hub_descriptor =
    "12010002090001406b1d0200060503020101"  // device
    "090219000101"
    "00e000"              // configuration
    "090400000109000000"  // interface
    "0705810304000c";     // endpoint

}  // namespace

class UsbDevice::Bus {
public:
  Bus(DeviceModel& model, const Shape& shape) : model_(model), shape_(shape), testbed_(umockdev_testbed_new()) {
    add(usb_entry("/devices/usb1", "1", "480", root_hub_descriptor));
    model_.on_unplug([this] { gone_ = true; });
    plug();
    pump_ = std::thread([this] { pump(); });
  }
  ~Bus() {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    wake_.notify_all();
    pump_.join();
    model_.on_unplug({});
    if (present_) umockdev_testbed_detach_ioctl(testbed_, node, nullptr);
    g_object_unref(testbed_);
  }

  void plug() {
    const std::lock_guard lock(mutex_);
    model_.plug(true);
    gone_ = false;
    driver_is_bound_ = true;
    add(usb_entry("/devices/usb1/1-2", "4", "12", hex(descriptors(shape_))));
    UMockdevIoctlBase* handler = umockdev_ioctl_base_new();
    g_signal_connect_after(handler, "handle-ioctl", G_CALLBACK(&Bus::handle_signal), this);
    umockdev_testbed_attach_ioctl(testbed_, node, handler, nullptr);
    g_object_unref(handler);
    umockdev_testbed_uevent(testbed_, system_path, "add");
    present_ = true;
  }
  void unplug() {
    model_.plug(false);
    gone_ = true;
    wake_.notify_all();
    while (present_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  [[nodiscard]] bool driver_is_bound() {
    const std::lock_guard lock(mutex_);
    return driver_is_bound_;
  }

private:
  struct Urb {
    Data data, buffer;
    [[nodiscard]] usbdevfs_urb* operator->() const { return reinterpret_cast<usbdevfs_urb*>(data->data); }
  };

  void add(const std::string& entry) {
    GError* error = nullptr;
    if (!umockdev_testbed_add_from_string(testbed_, entry.c_str(), &error)) {
      throw std::runtime_error(std::string("umockdev: ") + error->message);
    }
  }

  static gboolean handle_signal(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
    return static_cast<Bus*>(self)->handle(client) ? TRUE : FALSE;
  }

  bool handle(UMockdevIoctlClient* client) {
    const std::lock_guard lock(mutex_);
    UMockdevIoctlData* arg = umockdev_ioctl_client_get_arg(client);
    const auto request = umockdev_ioctl_client_get_request(client);
    const bool reaps = request == USBDEVFS_REAPURB || request == USBDEVFS_REAPURBNDELAY;
    if (gone_ && !(reaps && !done_.empty())) {
      complete(client, ENODEV);
      return true;
    }
    switch (request) {
      case USBDEVFS_GET_CAPABILITIES: {
        const Data capabilities = resolve(arg, 0, sizeof(std::uint32_t));
        const std::uint32_t value = USBDEVFS_CAP_REAP_AFTER_DISCONNECT | USBDEVFS_CAP_NO_PACKET_SIZE_LIM;
        std::memcpy(capabilities->data, &value, sizeof value);
        complete(client, 0);
        return true;
      }
      case USBDEVFS_SUBMITURB:
        submit(client, arg);
        return true;
      case USBDEVFS_REAPURB:
      case USBDEVFS_REAPURBNDELAY:
        reap(client);
        return true;
      case USBDEVFS_DISCARDURB:
        discard(client, arg);
        return true;
      case USBDEVFS_CLEAR_HALT:
      case USBDEVFS_RESETEP:
        complete(client, 0);
        return true;
      default:
        return handle_driver(client, arg, request);
    }
  }

  /// Who has the interface: the kernel's driver, or a program.
  bool handle_driver(UMockdevIoctlClient* client, UMockdevIoctlData* arg, gulong request) {
    switch (request) {
      case USBDEVFS_GETDRIVER: {
        const Data driver = resolve(arg, 0, sizeof(usbdevfs_getdriver));
        std::strcpy(reinterpret_cast<usbdevfs_getdriver*>(driver->data)->driver, "usbhid");
        complete(client, driver_is_bound_ ? 0 : ENODATA);
        return true;
      }
      case USBDEVFS_CLAIMINTERFACE:
        complete(client, driver_is_bound_ ? EBUSY : 0);
        return true;
      case USBDEVFS_DISCONNECT_CLAIM:
        driver_is_bound_ = false;
        complete(client, 0);
        return true;
      case USBDEVFS_RELEASEINTERFACE:
        complete(client, 0);
        return true;
      case USBDEVFS_IOCTL: {
        const Data inner = resolve(arg, 0, sizeof(usbdevfs_ioctl));
        const auto code = static_cast<unsigned>(reinterpret_cast<usbdevfs_ioctl*>(inner->data)->ioctl_code);
        if (code == USBDEVFS_CONNECT) driver_is_bound_ = true;
        if (code == USBDEVFS_DISCONNECT) driver_is_bound_ = false;
        complete(client, 0);
        return true;
      }
      default:
        complete(client, ENOTTY);
        return true;
    }
  }

  void submit(UMockdevIoctlClient* client, UMockdevIoctlData* arg) {
    Urb urb{resolve(arg, 0, sizeof(usbdevfs_urb)), {}};
    if (urb->buffer_length > 0) {
      urb.buffer =
          resolve(urb.data.get(), offsetof(usbdevfs_urb, buffer), static_cast<std::size_t>(urb->buffer_length));
    }
    if (urb->type == USBDEVFS_URB_TYPE_INTERRUPT && urb->endpoint == shape_.in_endpoint) {
      reading_.push_back(std::move(urb));
    } else if (urb->type == USBDEVFS_URB_TYPE_INTERRUPT && urb->endpoint == shape_.out_endpoint && urb.buffer) {
      const Bytes report(urb.buffer->data, urb.buffer->data + urb->buffer_length);
      finish(std::move(urb), model_.receive_report(report), report.size());
    } else {
      finish(std::move(urb), DeviceModel::Taken::Stalled, 0);  // no control requests are answered
    }
    complete(client, 0);
    fill_reads();
    answer_reap(false);
  }

  void finish(Urb urb, DeviceModel::Taken taken, std::size_t bytes) {
    using Taken = DeviceModel::Taken;
    urb->status = taken == Taken::Yes ? 0 : taken == Taken::Stalled ? -EPIPE : -ESHUTDOWN;
    urb->actual_length = taken == Taken::Yes ? static_cast<int>(bytes) : 0;
    if (taken == Taken::Gone) gone_ = true;
    done_.push_back(std::move(urb));
  }

  void fill_reads() {
    while (!reading_.empty()) {
      std::optional<Bytes> report;
      const auto taken = model_.next_report(report);
      if (taken == DeviceModel::Taken::Yes && !report) return;
      Urb urb = std::move(reading_.front());
      reading_.pop_front();
      const std::size_t bytes = report ? report->size() : 0;
      if (report) std::copy(report->begin(), report->end(), urb.buffer->data);
      finish(std::move(urb), taken, bytes);
    }
  }

  void discard(UMockdevIoctlClient* client, UMockdevIoctlData* arg) {
    const gulong address = *reinterpret_cast<gulong*>(arg->data);
    for (auto it = reading_.begin(); it != reading_.end(); ++it) {
      if (it->data->client_addr != address) continue;
      (*it)->status = -ENOENT;
      (*it)->actual_length = 0;
      done_.push_back(std::move(*it));
      reading_.erase(it);
      complete(client, 0);
      return answer_reap(false);
    }
    complete(client, EINVAL);
  }

  /// The node is a plain file, so that libusb would ask without end: an empty answer waits a little.
  void reap(UMockdevIoctlClient* client) {
    if (reaping_ != nullptr) answer_reap(true);
    reaping_ = UMOCKDEV_IOCTL_CLIENT(g_object_ref(client));
    reaping_since_ = std::chrono::steady_clock::now();
    answer_reap(false);
    wake_.notify_all();
  }

  void answer_reap(bool even_empty) {
    if (reaping_ == nullptr || (done_.empty() && !even_empty)) return;
    UMockdevIoctlClient* client = std::exchange(reaping_, nullptr);
    if (done_.empty()) {
      complete(client, gone_ ? ENODEV : EAGAIN);
    } else {
      const Data slot = resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(void*));
      umockdev_ioctl_data_set_ptr(slot.get(), 0, done_.front().data.get());
      complete(client, 0);
      done_.pop_front();
    }
    g_object_unref(client);
  }

  void pump() {
    std::unique_lock lock(mutex_);
    while (!ends_) {
      wake_.wait_for(lock, std::chrono::milliseconds(reaping_ != nullptr ? 1 : 5));
      if (gone_ && present_) leave();
      const bool held_enough = std::chrono::steady_clock::now() - reaping_since_ > empty_reap_hold;
      answer_reap(held_enough);
    }
    answer_reap(true);
  }

  /// What the kernel does when the cable is pulled: pending transfers end, the device leaves the tree.
  void leave() {
    while (!reading_.empty()) {
      Urb urb = std::move(reading_.front());
      reading_.pop_front();
      finish(std::move(urb), DeviceModel::Taken::Gone, 0);
    }
    answer_reap(true);
    umockdev_testbed_uevent(testbed_, system_path, "remove");
    umockdev_testbed_detach_ioctl(testbed_, node, nullptr);
    umockdev_testbed_remove_device(testbed_, system_path);
    present_ = false;
  }

  DeviceModel& model_;
  Shape shape_;
  UMockdevTestbed* testbed_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::thread pump_;
  bool ends_ = false;
  std::atomic<bool> gone_ = false, present_ = false;
  bool driver_is_bound_ = true;
  std::deque<Urb> reading_, done_;
  UMockdevIoctlClient* reaping_ = nullptr;
  std::chrono::steady_clock::time_point reaping_since_;
};

UsbDevice::UsbDevice(DeviceModel& model, const Shape& shape) : bus_(std::make_unique<Bus>(model, shape)) {}
UsbDevice::~UsbDevice() = default;
void UsbDevice::unplug() { bus_->unplug(); }
void UsbDevice::plug() { bus_->plug(); }
bool UsbDevice::kernel_driver_is_bound() { return bus_->driver_is_bound(); }

}  // namespace mezzotint::emulator
