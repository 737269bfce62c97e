#pragma once

#include <Eigen/Core>
#include <complex>
#include <filesystem>
#include <vector>

#include "analysis/psychophysics/study/quantity.h"

namespace haptrial::analysis::trials {

struct TrialsData;

/// How a hand followed a target that moved. Numbers are NaN at frequencies that the target lacks.
struct PursuitResponse {
  double error{0.0};     // root mean square of the distance, in the directions it moved in [m]
  double followed{0.0};  // share of the variance about the hand's drift that the frequencies hold
  std::vector<std::complex<double>> response;  // (frequencies) hand over target, exp(+iωt)
};

/// Target and hand are fitted by a line in time and sines of the frequencies (least squares), along
/// the direction in which the target swings.
/// @param target, hand  (ticks) places [m]; @param rate [Hz]
/// @param frequencies  all of the target's: others would leak into these [Hz]
PursuitResponse pursuit_response(const std::vector<Eigen::Vector3d>& target,
                                 const std::vector<Eigen::Vector3d>& hand, double rate,
                                 const std::vector<double>& frequencies);

/// Tracking error, share that follows, and gain and lag at each frequency, tested between the
/// conditions of TrialsPlan::by. A value is a participant's under a condition: the mean over
/// trials, of responses as complex numbers.
/// @param files  of TrialsData::sessions, in their order
/// @throws InputError naming a file that is damaged, or as quantity() does
std::vector<Quantity> pursuit_quantities(const TrialsData& data,
                                         const std::vector<std::filesystem::path>& files,
                                         const TrialsPlan& plan, int threads);

}  // namespace haptrial::analysis::trials
