// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/attitude.hpp
/// How a body flies, from its points: masses m, places x, velocities v.
///   centre c = sum m x/M, mean velocity V = sum m v/M, second moments Q = sum m (x - c)(x - c)^T
///   angular momentum L = sum m (x - c) x v, about the body's own centre
///   long axis d: eigenvector of Q whose eigenvalue is farthest from the others: along a rod,
///   across a disc; none where the eigenvalues are alike (a sphere, a cube)
///   obliquity  angle of V to a line     yaw  of d to V     tilt  of d to a line
/// Angles between lines, 0 to pi/2. A plane of symmetry that cuts the body stands for its other
/// half: V, c and d then keep no component across it but where d is the normal itself. About the
/// axis of the axisymmetric frame nothing turns; in plane strain all turning is about y.
#include "krater/measure/measures.hpp"

namespace krater {

/// Component along `direction`; in plane strain about y, whatever it is [kg m^2/s].
double angular_momentum(const BodyPoints& body, const MeasureContext& context,
                        const Triple& direction);
/// Not a number at rest [rad].
double obliquity(const BodyPoints& body, const MeasureContext& context, const Triple& line);
/// Not a number at rest or without a long axis [rad].
double yaw(const BodyPoints& body, const MeasureContext& context);
double tilt(const BodyPoints& body, const MeasureContext& context, const Triple& line);

}  // namespace krater
