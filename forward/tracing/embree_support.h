#pragma once

#include <embree3/rtcore.h>

/// Inside of forward/tracing.

namespace mezzotint {

/// @throws DeviceError that names what was tried.
[[noreturn]] void fail_embree(RTCError code, const char* what);

/// Embree's device and one scene for rays whose context has a filter: robust, so that rays cannot pass between two
/// triangles that share an edge.
/// @throws DeviceError where Embree cannot start; MethodError where it cannot filter hits.
class EmbreeScene {
public:
  EmbreeScene();
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// A scene more, of the same kind; the caller releases it.
  [[nodiscard]] RTCScene make_scene() const;
  /// Builds the tree.
  void commit(RTCScene built) const;

  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
};

}  // namespace mezzotint
