#include "analysis/device/frequency_response.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "analysis/device/least_squares.h"
#include "core/device/motor_faults.h"

namespace haptrial::analysis {
namespace {

using Complex = std::complex<double>;
using Eigen::VectorXd;

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kClearOrder = 20.0;  // F ratio above which a second order is part of the model

struct MeanResponse {
  std::vector<double> frequency;  // [Hz]
  std::vector<Complex> mean;      // over the periods
  std::vector<double> error;      // of its real and imaginary part, each
};

Complex tone(const std::vector<Eigen::Vector3d>& signal, long begin, long period, long axis,
             double frequency, double rate) {
  const Complex turn = std::polar(1.0, -2.0 * kHalfTurn * frequency / rate);
  Complex at = 1.0, sum = 0.0;
  for (long t = 0; t < period; ++t) {
    sum += at * signal[static_cast<std::size_t>(begin + t)][axis];
    at *= turn;
  }
  return sum;
}

/// @param number  of the driven axis
MeanResponse mean_response(const PartRecord& part, const Excitation& excitation, long number) {
  const int axis = excitation.axes()[static_cast<std::size_t>(number)];
  const long period = excitation.period_ticks();
  const long begin = number * (1 + Excitation::kPeriods) * period + period;
  const double n = Excitation::kPeriods;
  MeanResponse found;
  for (const int frequency : excitation.frequencies()) {
    std::vector<Complex> each;
    Complex mean = 0.0;
    for (long p = 0; p < Excitation::kPeriods; ++p) {
      const long at = begin + p * period;
      each.push_back(tone(part.measured, at, period, axis, frequency, excitation.rate()) /
                     tone(part.command, at, period, axis, frequency, excitation.rate()));
      mean += each.back() / n;
    }
    double square = 0.0;
    for (const Complex& one : each) {
      square += 0.5 * std::norm(one - mean);
    }
    found.frequency.push_back(frequency);
    found.mean.push_back(mean);
    found.error.push_back(std::sqrt(square / (n * (n - 1.0))));
  }
  return found;
}

/// A held command through the second order, seen at the end of each tick.
Complex second_order(double frequency, double resonance, double damping, double rate) {
  const Eigen::Matrix2d step = device::resonator_step(resonance, damping, 1.0 / rate);
  const Complex z = std::polar(1.0, 2.0 * kHalfTurn * frequency / rate);
  const Eigen::Matrix2cd left = z * Eigen::Matrix2cd::Identity() - step.cast<Complex>();
  const Eigen::Vector2cd in = (Eigen::Matrix2d::Identity() - step).col(0).cast<Complex>();
  return (left.inverse() * in)[0];
}

/// @param p  gain, delay [s], and logarithms of resonance [Hz] and damping if there is one
Complex modelled_response(double frequency, const VectorXd& p, double rate) {
  const Complex late = std::polar(p[0], -2.0 * kHalfTurn * frequency * p[1]);
  return late * (p.size() > 2 ? second_order(frequency, std::exp(p[2]), std::exp(p[3]), rate)
                              : std::polar(1.0, -2.0 * kHalfTurn * frequency / rate));
}

FittedParameters fit_model(const MeanResponse& response, const VectorXd& start, double rate) {
  const std::size_t n = response.mean.size();
  const VectorXd scale = (VectorXd(4) << 0.1, 1e-3, 0.1, 0.1).finished().head(start.size());
  return fit_least_squares(
      start, scale, 2 * static_cast<long>(n), [&](const VectorXd& p, VectorXd& r) {
        for (std::size_t i = 0; i < n; ++i) {
          const Complex error =
              response.mean[i] - modelled_response(response.frequency[i], p, rate);
          r[static_cast<long>(2 * i)] = error.real();
          r[static_cast<long>(2 * i + 1)] = error.imag();
        }
      });
}

/// The delay that turns the phase of the lowest frequencies.
double first_delay(const MeanResponse& response, double rate) {
  double turned = 0.0, weight = 0.0;
  Complex before = response.mean.front();
  double phase = std::arg(before);
  for (std::size_t i = 0; i < response.mean.size() && response.frequency[i] < 40.0; ++i) {
    phase += std::arg(response.mean[i] / before);
    before = response.mean[i];
    turned -= phase * response.frequency[i];
    weight += response.frequency[i] * response.frequency[i];
  }
  return turned / (2.0 * kHalfTurn * weight) - 1.0 / rate;
}

void fit_response(const MeanResponse& response, double rate, double age, AxisResponse& axis) {
  const double delay = first_delay(response, rate);
  const double gain = std::abs(response.mean.front());
  const FittedParameters rigid = fit_model(response, (VectorXd(2) << gain, delay).finished(), rate);
  FittedParameters best;
  best.chi_squared = rigid.chi_squared;
  for (double f = 8.0; f < 0.45 * rate; f *= 1.5) {
    for (const double damping : {0.05, 0.5}) {
      const double lag = std::max(delay - damping / (kHalfTurn * f), 0.0);
      const VectorXd start = (VectorXd(4) << gain, lag, std::log(f), std::log(damping)).finished();
      const FittedParameters fit = fit_model(response, start, rate);
      const double resonance = fit.value.size() == 4 ? std::exp(fit.value[2]) : 0.0;
      if (fit.chi_squared < best.chi_squared && resonance > response.frequency.front() &&
          resonance < 2.0 * response.frequency.back()) {
        best = fit;
      }
    }
  }
  const bool clear =
      best.value.size() == 4 && (rigid.chi_squared - best.chi_squared) / 2.0 >
                                    kClearOrder * best.chi_squared / std::max(best.df, 1.0);
  const FittedParameters& fit = clear ? best : rigid;
  axis.gain = fit.interval(0);
  axis.delay = fit.interval(1);
  for (double* part : {&axis.delay.value, &axis.delay.low, &axis.delay.high}) {
    *part -= age;
  }
  if (!clear) {
    return;
  }
  const VectorXd scale = (VectorXd(4) << 0.1, 1e-3, 0.1, 0.1).finished();
  axis.resonance = fit.interval([](const VectorXd& p) { return std::exp(p[2]); }, scale);
  axis.damping = fit.interval([](const VectorXd& p) { return std::exp(p[3]); }, scale);
  const Interval bandwidth = fit.interval(
      [](const VectorXd& p) { return std::exp(p[2]) * bandwidth_per_resonance(std::exp(p[3])); },
      scale);
  if (bandwidth.value <= response.frequency.back()) {
    axis.bandwidth = bandwidth;
  }
}

}  // namespace

double bandwidth_per_resonance(double damping) {
  const double c = 1.0 - 2.0 * damping * damping;
  return std::sqrt(c + std::sqrt(c * c + 1.0));
}

std::vector<AxisResponse> identify_frequency_response(const CertificateRecord& record,
                                                      const Excitation& excitation) {
  std::vector<AxisResponse> axes(excitation.axes().size());
  for (long a = 0; a < static_cast<long>(axes.size()); ++a) {
    AxisResponse& axis = axes[static_cast<std::size_t>(a)];
    const MeanResponse response =
        mean_response(record.part(CertificatePart::kFrequency), excitation, a);
    const double df = 2.0 * (Excitation::kPeriods - 1);
    double pooled = 0.0;  // the noise of a force sensor is alike at all frequencies
    for (const double error : response.error) {
      pooled += error * error / static_cast<double>(response.error.size());
    }
    const double error = std::sqrt(pooled);
    const double all = df * static_cast<double>(response.error.size());
    double phase = 0.0;
    Complex before = 1.0;
    for (std::size_t i = 0; i < response.mean.size(); ++i) {
      const double size = std::abs(response.mean[i]);
      phase += std::arg(response.mean[i] / before);
      before = response.mean[i];
      axis.tones.push_back({response.frequency[i], interval_of(size, error, all),
                            interval_of(phase, error / size, all)});
    }
    fit_response(response, excitation.rate(), record.sensor_age, axis);
  }
  return axes;
}

}  // namespace haptrial::analysis
