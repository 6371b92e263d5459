#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "forward/process/printer_profile.h"

namespace mezzotint {

/// From coverage to the projector's gray, rounded once: to the level whose result is nearest to what is wanted.
class GrayTable {
public:
  /// Wanted is the height coverage × layer; a level yields what the printer's cure curve says, and dark yields 0.
  /// @throws InvalidInput for an invalid profile, or one with more than 256 gray levels: a job holds 8 bits.
  [[nodiscard]] static GrayTable through_cure(const PrinterProfile& profile, Length layer);
  /// Gray is the coverage, as other slicers have it.
  [[nodiscard]] static GrayTable linear();

  [[nodiscard]] std::uint8_t level(float coverage) const {
    std::size_t entry = start_[static_cast<std::size_t>(coverage * bins)];
    while (entry + 1 < entries_.size() && double{coverage} >= entries_[entry + 1].from) ++entry;
    return entries_[entry].level;
  }
  /// Whether the printer stays below what this coverage wants by more than half of its last gray step.
  [[nodiscard]] bool saturates(float coverage) const { return double{coverage} >= saturation_; }
  /// What full gray reaches of a whole layer; 1 where it reaches it.
  [[nodiscard]] double largest_coverage() const { return largest_; }

private:
  /// What a level yields, as a share of the layer.
  struct Yield {
    double coverage;
    std::uint8_t level;
  };
  explicit GrayTable(const std::vector<Yield>& yields);

  struct Entry {
    double from;  ///< coverage from which on this level is the nearest
    std::uint8_t level;
  };
  static constexpr float bins = 1024.0F;
  std::vector<Entry> entries_;
  std::array<std::uint16_t, 1025> start_ = {};  ///< the entry at the beginning of a bin
  double saturation_ = 2.0, largest_ = 1.0;
};

}  // namespace mezzotint
