#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <span>

namespace mezzotint {

/// Discrete Fourier transforms of one line, for who takes a plane apart into rows and columns: what is left out (rows
/// of zeros, lags that nobody asks for) then costs nothing, and a column is worked on while it is in the cache.
///
/// Sign, threads, result   as RealFft2d; both directions are unscaled here.
/// @throws InvalidInput for a length of 0 or above 2^16.
class RealFftLine {
public:
  explicit RealFftLine(std::size_t length);
  ~RealFftLine();
  RealFftLine(RealFftLine&&) noexcept;
  RealFftLine(const RealFftLine&) = delete;
  RealFftLine& operator=(const RealFftLine&) = delete;

  [[nodiscard]] std::span<double> real();
  [[nodiscard]] std::span<std::complex<double>> spectrum();  ///< length/2 + 1
  void forward();                                            ///< real() → spectrum(); real() keeps its content
  void inverse();                                            ///< spectrum() → real(); spectrum() is used up

private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

/// The same of complex values, forward and in place.
class ComplexFftLine {
public:
  explicit ComplexFftLine(std::size_t length);
  ~ComplexFftLine();
  ComplexFftLine(ComplexFftLine&&) noexcept;
  ComplexFftLine(const ComplexFftLine&) = delete;
  ComplexFftLine& operator=(const ComplexFftLine&) = delete;

  [[nodiscard]] std::span<std::complex<double>> values();
  void forward();

private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace mezzotint
