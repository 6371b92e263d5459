#include "forward/tracing/embree_support.h"

#include <string>

#include "forward/base/error.h"

namespace mezzotint {

void fail_embree(RTCError code, const char* what) {
  throw DeviceError(std::string("Embree: ") + what + " failed (error " + std::to_string(static_cast<int>(code)) +
                    (code == RTC_ERROR_OUT_OF_MEMORY ? ", out of memory; a smaller patch would fit)" : ")"));
}

EmbreeScene::EmbreeScene() : device(rtcNewDevice(nullptr)) {
  if (device == nullptr) fail_embree(rtcGetDeviceError(nullptr), "starting");
  if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED) == 0) {
    rtcReleaseDevice(device);
    throw MethodError("this build of Embree has no filter functions; rays could not leave a surface safely");
  }
  scene = make_scene();
}

EmbreeScene::~EmbreeScene() {
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
}

RTCScene EmbreeScene::make_scene() const {
  RTCScene made = rtcNewScene(device);
  rtcSetSceneFlags(made, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  rtcSetSceneBuildQuality(made, RTC_BUILD_QUALITY_MEDIUM);
  return made;
}

void EmbreeScene::commit(RTCScene built) const {
  rtcCommitScene(built);
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE) fail_embree(error, "building the tree of triangles");
}

}  // namespace mezzotint
