#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <span>

namespace mezzotint {

/// Discrete Fourier transform of a real array over a plane, and back.
///
/// Shape    real(): rows × columns, row after row. spectrum(): rows × (columns/2 + 1); entry (kx, ky) belongs
///          to the frequency kx/columns, ky/rows cycles a sample (ky > rows/2 means ky − rows). The rest follows
///          from S(−k) = conj S(k), so a sum over all frequencies counts the columns by `weight(kx)`.
/// Sign     forward: S(k) = Σ f(n) exp(−2πi k·n), unscaled; inverse: f(n) = 1/N Σ S(k) exp(+2πi k·n).
/// Threads  one object belongs to one thread at a time; different objects may work at once.
/// Result   the same bits in every run: plans are estimated, never measured (see fft.cpp).
/// Source   Frigo & Johnson, "The Design and Implementation of FFTW3", Proc. IEEE 93 (2005).
class RealFft2d {
public:
  /// Arrays are zero at first.
  /// @throws InvalidInput for a side of 0 or above 2^16 samples.
  RealFft2d(std::size_t columns, std::size_t rows);
  ~RealFft2d();
  RealFft2d(RealFft2d&&) noexcept;
  RealFft2d& operator=(RealFft2d&&) noexcept;
  RealFft2d(const RealFft2d&) = delete;
  RealFft2d& operator=(const RealFft2d&) = delete;

  [[nodiscard]] std::size_t columns() const;
  [[nodiscard]] std::size_t rows() const;
  [[nodiscard]] std::size_t spectrum_columns() const { return columns() / 2 + 1; }

  /// How often column kx of the spectrum counts: 1 where it is its own mirror image, else 2.
  [[nodiscard]] double weight(std::size_t kx) const { return kx == 0 || 2 * kx == columns() ? 1.0 : 2.0; }

  [[nodiscard]] std::span<double> real();
  [[nodiscard]] std::span<std::complex<double>> spectrum();

  /// real() → spectrum(); real() keeps its content.
  void forward();
  /// spectrum() → real(); spectrum() is used up.
  void inverse();

private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

/// The next even length ≥ `length` with no prime factor above 5: the lengths that FFTW transforms quickly.
[[nodiscard]] std::size_t quick_fft_length(std::size_t length);

}  // namespace mezzotint
