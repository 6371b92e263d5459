#pragma once

#include "fabrication/device/light_engine.h"

namespace mezzotint {

/// A light engine that lights nothing and takes its time: the virtual printer's, for rehearsals.
class VirtualLight final : public LightEngine {
public:
  /// @param clock  outlives the engine
  VirtualLight(Clock& clock, std::size_t columns, std::size_t rows);

  [[nodiscard]] const LightEngineIdentity& identity() const override { return identity_; }
  void prepare(const LightSettings& settings) override;
  [[nodiscard]] UploadEstimate estimate(const ShownPicture& picture) const override;
  void show(const ShownPicture& picture, Clock::Duration exposure) override;
  [[nodiscard]] ExposureReport expose(const std::function<bool()>& go_on) override;
  void light_off() override { is_on_ = false; }
  [[nodiscard]] bool try_light_off() noexcept override {
    is_on_ = false;
    return true;
  }
  [[nodiscard]] LightStatus status() override { return {is_on_, true, {}}; }

private:
  Clock& clock_;
  LightEngineIdentity identity_;
  Clock::Duration exposure_{0};
  bool is_shown_ = false, is_on_ = false;
};

}  // namespace mezzotint
