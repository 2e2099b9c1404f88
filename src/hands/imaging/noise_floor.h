// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hands/imaging/volume.h"

namespace palmar::imaging {

/// Takes the floor out of a magnitude image: noise has no sign in one, so that air isn't dark and
/// every threshold half way between air and tissue lies too high. The square of a magnitude M with
/// signal A and noise of standard deviation sigma in each of two channels has the mean
/// A^2 + 2 sigma^2, whatever A (Gudbjartsson, Patz 1995, eq. 1 and 6), so
///
///     A = sign(M^2 - 2 sigma^2) sqrt|M^2 - 2 sigma^2|.
///
/// The sign keeps the mean of air near 0 (-0.2 sigma). sigma 0 changes nothing.
double without_noise_floor(double magnitude, double sigma);
Volume without_noise_floor(Volume image, double sigma);

/// The magnitude that a signal has in the mean, at 2 sigma and more.
double with_noise_floor(double signal, double sigma);

}  // namespace palmar::imaging
