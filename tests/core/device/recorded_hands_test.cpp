// Recorded movements of people's hands raise no alarm: against the forces that were measured there,
// and through a medium. (The arm in csrl_ur_admittance_human oscillated itself, at 20 to 25 Hz, so
// that its forces would.)

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "core/control/pd_controller.h"
#include "core/device/envelope.h"
#include "tests/support/shared_data.h"

namespace haptrial::device::recorded_hands_test {
namespace {

using Eigen::Vector3d;

struct Instant {
  double time;        // [s]
  Vector3d position;  // [m]
  Vector3d force;     // measured [N]
};

/// Rows of numbers below a line of names; the places are those of time, position and force.
std::vector<Instant> read_rows(const std::filesystem::path& file, char separator, int position,
                               int force) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  std::vector<Instant> rows;
  while (std::getline(stream, line)) {
    std::replace(line.begin(), line.end(), separator, ' ');
    std::istringstream words(line);
    const std::vector<double> n{std::istream_iterator<double>(words), {}};
    const auto three = [&](int at) { return Vector3d(n.at(at), n.at(at + 1), n.at(at + 2)); };
    rows.push_back({n.at(0), three(position), three(force)});
  }
  return rows;
}

/// Rows at which the position changed; a tracker gives a new one at 30 Hz, beside faster forces.
std::vector<Instant> changes(const std::vector<Instant>& rows) {
  std::vector<Instant> kept{rows.front()};
  for (const Instant& row : rows) {
    if (row.position != kept.back().position && row.time > kept.back().time) {
      kept.push_back(row);
    }
  }
  return kept;
}

Vector3d between(const std::vector<Instant>& rows, double time, Vector3d Instant::*what) {
  const auto after = std::find_if(rows.begin() + 1, rows.end() - 1,
                                  [&](const Instant& row) { return row.time >= time; });
  const Instant& before = *(after - 1);
  const double share = std::clamp((time - before.time) / (after->time - before.time), 0.0, 1.0);
  return before.*what + share * (*after.*what - before.*what);
}

/// The slope over the last readings, as the velocity of a device is estimated.
Vector3d slope(const std::deque<Vector3d>& readings, double dt) {
  const double middle = 0.5 * (static_cast<double>(readings.size()) - 1.0);
  Vector3d sum = Vector3d::Zero();
  double squares = 0.0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    sum += (static_cast<double>(i) - middle) * readings[i];
    squares += (static_cast<double>(i) - middle) * (static_cast<double>(i) - middle);
  }
  return squares > 0.0 ? Vector3d(sum / (squares * dt)) : Vector3d::Zero();
}

using ForceAt = std::function<Vector3d(double time, const Vector3d& velocity)>;

/// The fault that ends the recording, presented at 1 kHz with encoders of 10 um.
Fault presented(const std::vector<Instant>& places, const ForceAt& force_at) {
  constexpr double kDt = 1e-3;
  constexpr double kStep = 1e-5;  // of an encoder [m]
  EnvelopeLimits limits;
  limits.workspace_radius = 10.0;  // these hands went further, and pressed harder, than at a desk
  limits.max_force = 100.0;
  Envelope envelope(limits);
  std::deque<Vector3d> readings;
  for (double t = places.front().time; t < places.back().time; t += kDt) {
    DeviceReading reading;
    reading.tool.position =
        kStep * (between(places, t, &Instant::position) / kStep).array().round();
    readings.push_back(reading.tool.position);
    if (readings.size() > 8) {
      readings.pop_front();
    }
    reading.tool.velocity = slope(readings, kDt);
    if (envelope.check(true, reading) != Fault::kNone) {
      break;
    }
    ForceIntent intent;
    intent.push = control::saturate(force_at(t, reading.tool.velocity), 0.99 * limits.max_force);
    envelope.limit(intent.push, kDt, intent);
  }
  return envelope.fault();
}

std::string test_name(std::string file) {
  std::replace_if(
      file.begin(), file.end(), [](char c) { return std::isalnum(c) == 0; }, '_');
  return file;
}

class RecordedHandsTest : public testing::TestWithParam<std::string> {};

TEST_P(RecordedHandsTest, RaiseNoAlarm) {
  const auto file = test::shared_data("haptic/" + GetParam());
  if (!file) {
    GTEST_SKIP() << "neither HAPTRIAL_DATA nor ../shared/data holds haptic/" << GetParam();
  }
  const bool table = GetParam().ends_with(".csv");
  const std::vector<Instant> rows = read_rows(*file, table ? ',' : '\t', 1, table ? 11 : 8);
  const std::vector<Instant> places = changes(rows);
  const auto medium = [](double, const Vector3d& velocity) { return Vector3d(-20.0 * velocity); };
  EXPECT_STREQ(describe(presented(places, medium)), describe(Fault::kNone));
  if (!table) {
    const auto measured = [&](double t, const Vector3d&) {
      return between(rows, t, &Instant::force);
    };
    EXPECT_STREQ(describe(presented(places, measured)), describe(Fault::kNone));
  }
}

INSTANTIATE_TEST_SUITE_P(Recordings, RecordedHandsTest,
                         testing::Values("csrl_ur_admittance_human_500Hz.csv",
                                         "contour/demo_a_1.dat", "contour/demo_b_1.dat",
                                         "contour/demo_c_1.dat", "contour/demo_d_1.dat",
                                         "contour/demo_e_1.dat", "contour/demo_f_1.dat"),
                         [](const auto& recording) { return test_name(recording.param); });

}  // namespace
}  // namespace haptrial::device::recorded_hands_test
