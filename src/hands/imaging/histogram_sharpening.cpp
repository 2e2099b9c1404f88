// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/histogram_sharpening.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

namespace palmar::imaging {
namespace {

using Spectrum = std::vector<std::complex<double>>;

/// Real parts of a spectrum's inverse.
std::vector<double> inverse_real(Eigen::FFT<double>& fft, const Spectrum& spectrum) {
  Spectrum back;
  fft.inv(back, spectrum);
  std::vector<double> result(back.size());
  for (std::size_t i = 0; i < back.size(); ++i) result[i] = back[i].real();
  return result;
}

Spectrum transform(Eigen::FFT<double>& fft, const std::vector<double>& values) {
  Spectrum result;
  fft.fwd(result, Spectrum(values.begin(), values.end()));
  return result;
}

/// values blurred by the kernel whose spectrum is given.
std::vector<double> blurred(Eigen::FFT<double>& fft, const std::vector<double>& values,
                            const Spectrum& kernel) {
  Spectrum spectrum = transform(fft, values);
  for (std::size_t i = 0; i < spectrum.size(); ++i) spectrum[i] *= kernel[i];
  return inverse_real(fft, spectrum);
}

}  // namespace

std::vector<double> sharpened(const std::vector<double>& values, const SharpeningOptions& options) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (values.empty() || !(*most > *least)) return values;
  const double low = *least;
  const double bin = (*most - *least) / (options.bins - 1);
  // Twice as long, so that the blur doesn't come round from the other end.
  const auto bins = static_cast<std::size_t>(options.bins);
  std::size_t length = 1;
  while (length < 2 * bins) length *= 2;
  const std::size_t first = (length - bins) / 2;

  std::vector<double> histogram(length, 0.0);
  for (const double value : values) {
    const double at = (value - low) / bin;
    const auto b = std::min(static_cast<std::size_t>(at), bins - 2);
    const double share = at - static_cast<double>(b);
    histogram[first + b] += 1.0 - share;
    histogram[first + b + 1] += share;
  }
  const double width = options.width / bin;  // in bins
  std::vector<double> gauss(length);
  double total = 0.0;
  for (std::size_t i = 0; i < length; ++i) {
    const auto away = static_cast<double>(std::min(i, length - i));
    gauss[i] = std::exp(-4.0 * std::log(2.0) * away * away / (width * width));
    total += gauss[i];
  }
  for (double& value : gauss) value /= total;

  Eigen::FFT<double> fft;
  const Spectrum blur = transform(fft, gauss);
  Spectrum inverse(length);
  for (std::size_t i = 0; i < length; ++i) {
    const double f = blur[i].real();  // symmetric: real
    inverse[i] = f / (f * f + options.noise);
  }
  std::vector<double> sharp = blurred(fft, histogram, inverse);
  std::vector<double> moment(length);
  for (std::size_t i = 0; i < length; ++i) {
    sharp[i] = std::max(0.0, sharp[i]);
    moment[i] = sharp[i] * (static_cast<double>(i) - static_cast<double>(first));
  }
  const std::vector<double> weight = blurred(fft, sharp, blur);
  const std::vector<double> mean = blurred(fft, moment, blur);
  const double least_weight = 1e-9 * static_cast<double>(values.size());
  std::vector<double> expected(bins);
  for (std::size_t b = 0; b < bins; ++b) {
    const std::size_t i = first + b;
    // Where nothing was sharpened to, values stay.
    expected[b] =
        low + bin * (weight[i] > least_weight ? mean[i] / weight[i] : static_cast<double>(b));
  }
  std::vector<double> result(values.size());
  for (std::size_t v = 0; v < values.size(); ++v) {
    const double at = (values[v] - low) / bin;
    const auto b = std::min(static_cast<std::size_t>(at), bins - 2);
    const double share = at - static_cast<double>(b);
    result[v] = (1.0 - share) * expected[b] + share * expected[b + 1];
  }
  return result;
}

}  // namespace palmar::imaging
