// A free body of springs over 10^6 steps of Verlet's method: what it keeps of momentum and energy
// with the exact forces, and with the forms that the source prints. Simulated.
//
//     bench_springs_study [--figures FOLDER]

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "analysis/document/figure_gnuplot.h"
#include "core/base/random.h"
#include "core/deformable/springs/spring_forces.h"
#include "core/deformable/springs/spring_tangent.h"
#include "tests/support/solid_block.h"

namespace {

using namespace haptrial::deformable;
using Eigen::Vector3d;

constexpr int kSteps = 1'000'000;

/// How far momenta have gone from the first, relative to what the vertices carry without regard to
/// direction; and the energy relative to the first.
struct State {
  double momentum, angular, energy;
};

class Swarm {
 public:
  Swarm(const SpringBody& body, ForceForm form)
      : body_(body),
        form_(form),
        springs_(body),
        x_(body.rest),
        v_(body.rest.size()),
        step_(0.3 * stable_step(body)) {
    haptrial::RandomStream random(4, "push");
    for (Vector3d& v : v_) {
      v = 0.02 * Vector3d(random.normal(), random.normal(), random.normal());
    }
    first_ = sums();
    first_energy_ = energy();
  }
  void step() {
    const std::vector<Vector3d> f = forces();
    for (std::size_t i = 0; i < v_.size(); ++i) {
      v_[i] += step_ / body_.masses[i] * f[i];
      x_[i] += step_ * v_[i];
    }
  }
  State state() const {
    const Sums now = sums();
    return {(now.momentum - first_.momentum).norm() / first_.size,
            (now.angular - first_.angular).norm() / first_.angular_size, energy() / first_energy_};
  }

 private:
  struct Sums {
    Vector3d momentum{Vector3d::Zero()}, angular{Vector3d::Zero()};
    double size{}, angular_size{};
  };
  std::vector<Vector3d> forces() const {
    return form_ == ForceForm::kExact ? springs_.forces(x_) : spring_forces(body_, x_, form_);
  }
  Sums sums() const {
    Sums s;
    for (std::size_t i = 0; i < v_.size(); ++i) {
      const Vector3d p = body_.masses[i] * v_[i];
      s.momentum += p;
      s.size += p.norm();
      s.angular += x_[i].cross(p);
      s.angular_size += x_[i].norm() * p.norm();
    }
    return s;
  }
  double energy() const {
    const std::vector<Vector3d> f = forces();
    double sum = spring_energy(body_, x_);
    for (std::size_t i = 0; i < v_.size(); ++i) {
      const Vector3d now = v_[i] + 0.5 * step_ / body_.masses[i] * f[i];
      sum += 0.5 * body_.masses[i] * now.squaredNorm();
    }
    return sum;
  }

  const SpringBody& body_;
  ForceForm form_;
  SpringForces springs_;
  std::vector<Vector3d> x_, v_;
  double step_;
  Sums first_;
  double first_energy_{};
};

haptrial::analysis::Series run(const SpringBody& body, ForceForm form, const char* label,
                               const haptrial::analysis::Look& look) {
  Swarm swarm(body, form);
  haptrial::analysis::Series series{label, haptrial::analysis::Mark::kLine, look};
  double next = 10;
  double low = 1;
  double high = 1;
  for (int step = 1; step <= kSteps; ++step) {
    swarm.step();
    const bool show = step >= static_cast<int>(next);
    if (!show && step % 100 != 0) {
      continue;
    }
    const State state = swarm.state();
    low = std::min(low, state.energy);
    high = std::max(high, state.energy);
    if (!show) {
      continue;
    }
    series.x.push_back(std::log10(step));
    series.y.push_back(std::log10(std::max(1e-18, state.momentum)));
    next *= std::sqrt(10.0);
    fmt::print("{:8} {:9} steps: momentum {:.2e}, angular {:.2e}, energy {:.4g} .. {:.4g}\n", label,
               step, state.momentum, state.angular, low, high);
    std::fflush(stdout);
  }
  return series;
}

}  // namespace

int main(int argc, char** argv) {
  const SpringBody body =
      spring_body(haptrial::test::solid_block({2, 2, 3}, 0.01), 1000, {0.02, 0.01, 0.05});
  haptrial::analysis::Figure figure;
  figure.series = {run(body, ForceForm::kExact, "exact", {"#0072b2", "solid", 0, 2.5}),
                   run(body, ForceForm::kPrinted, "as printed", {"#d55e00", "(9,4)", 0, 2.5})};
  figure.name = "deformable-springs";
  figure.title = "Change of momentum, relative to what all vertices carry";
  figure.x_label = "Steps";
  figure.y_label = "Change of momentum, power of ten";
  figure.x_names = {{1, "10"},     {2, "100"},     {3, "1,000"},
                    {4, "10,000"}, {5, "100,000"}, {6, "1,000,000"}};
  figure.simulated = true;
  figure.who = "BODY";
  if (argc == 3 && std::strcmp(argv[1], "--figures") == 0) {
    haptrial::analysis::draw_figures({figure}, argv[2]);
  }
  return 0;
}
