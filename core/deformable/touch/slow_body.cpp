#include "core/deformable/touch/slow_body.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>
#include <set>
#include <span>
#include <utility>

#include "core/deformable/springs/spring_hessian.h"
#include "core/deformable/touch/condense.h"
#include "core/deformable/touch/prepared.h"

namespace haptrial::deformable {
namespace {

std::vector<std::uint8_t> flags_of(const MovingBody& body) {
  std::vector<std::uint8_t> held(body.mesh->tets.vertices.size(), 0);
  for (const std::int32_t vertex : body.held) {
    held[static_cast<std::size_t>(vertex)] = 1;
  }
  return held;
}

std::vector<std::int32_t> touched_vertices(const MovingBody& body,
                                           const std::vector<std::uint8_t>& held) {
  std::set<std::int32_t> touched;
  for (const Face& face : body.mesh->felt) {
    for (const std::int32_t vertex : face) {
      if (held[static_cast<std::size_t>(vertex)] == 0) {
        touched.insert(vertex);
      }
    }
  }
  return {touched.begin(), touched.end()};
}

/// @param matrix  symmetric and positive definite; its lower half is read
Eigen::MatrixXf inverse_of(Eigen::MatrixXd matrix) {
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factors(matrix);
  Eigen::MatrixXd root = Eigen::MatrixXd::Identity(matrix.rows(), matrix.rows());
  factors.matrixL().solveInPlace(root);
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(matrix.rows(), matrix.rows());
  inverse.selfadjointView<Eigen::Lower>().rankUpdate(root.transpose());
  return inverse.selfadjointView<Eigen::Lower>().toDenseMatrix().cast<float>();
}

/// K + M / τ² at rest.
BlockMatrix stiffness_over(const MovingBody& body, double time) {
  const std::span<const double> masses =
      body.elements ? body.elements->masses() : std::span<const double>(body.springs.masses);
  std::vector<double> inertia(masses.begin(), masses.end());
  for (double& each : inertia) {
    each /= time * time;
  }
  const auto with_inertia = [&](BlockMatrix stiffness) {
    stiffness.scale_and_add(1.0, inertia);
    return stiffness;
  };
  if (!body.elements) {
    SpringHessian hessian(body.springs);
    hessian.assemble(body.springs, body.springs.rest);
    return with_inertia(std::move(hessian.matrix()));
  }
  BlockMatrix stiffness(body.elements->patches().groups(), masses.size());
  Vectors forces;
  body.elements->stiffness(Vectors(masses.size(), Eigen::Vector3d::Zero()), forces, stiffness);
  return with_inertia(std::move(stiffness));
}

struct WindowedTissue {
  SharedMovingBody body;
  double window;
  bool operator==(const WindowedTissue&) const = default;
};

}  // namespace

WindowCompliance::WindowCompliance(const MovingBody& body, double time) {
  const std::vector<std::uint8_t> held = flags_of(body);
  const std::vector<std::int32_t> touched = touched_vertices(body, held);
  place_.assign(held.size(), -1);
  for (std::size_t i = 0; i < touched.size(); ++i) {
    place_[static_cast<std::size_t>(touched[i])] = static_cast<std::int32_t>(i);
  }
  inverse_ =
      inverse_of(condensed(stiffness_over(body, time), body.mesh->tets.vertices, held, touched));
}

SharedWindowCompliance prepared_compliance(const SharedMovingBody& body, double window) {
  static PreparedBodies<WindowedTissue, WindowCompliance> bodies;
  return bodies.get({body->mesh, {body, window}}, [&] {
    check_memory(*body->mesh);
    return std::make_shared<const WindowCompliance>(*body, window);
  });
}

using Eigen::Matrix3f;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

constexpr int kLooks = 16;  // of the thread for a path, in a window

std::size_t sample_slot(std::int32_t i) { return static_cast<std::size_t>(i); }

}  // namespace

SlowBody::SlowBody(const SharedMovingBody& body, SharedWindowCompliance compliance,
                   const TouchOptions& options, double period, int window, bool threaded,
                   std::shared_ptr<MovingShape> shape)
    : body_(body),
      compliance_(std::move(compliance)),
      period_(period),
      ticks_of_step_(body->implicit ? window : 1),
      touch_(body, options, ticks_of_step_ * period, std::move(shape)) {
  const std::size_t samples = touch_.ball().samples().samples.size();
  near_.resize(samples);
  pressed_.assign(samples, 0);
  free_.assign(samples, Vector3d::Zero());
  described_.assign(samples, 0);
  loads_.resize(3 * BallContact::kMostPlaces);
  if (threaded) {
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }
}

void SlowBody::give(const BodyPath& path) noexcept {
  if (thread_.joinable()) {
    paths_.write(path);
  } else {
    advance(path);
  }
}

const LocalSurface* SlowBody::take() noexcept {
  return turn_.take() ? &slots_[turn_.reading()] : nullptr;
}

void SlowBody::run(const std::stop_token& stop) {
  BodyPath path;
  while (!stop.stop_requested()) {
    if (paths_.read(path)) {
      advance(path);
    } else {
      const double window = period_ * std::max(1, path.count);
      std::this_thread::sleep_for(std::chrono::duration<double>(window / kLooks));
    }
  }
}

void SlowBody::advance(const BodyPath& path) noexcept {
  ++window_;
  if (path.starts) {
    touch_.start(path.from);
    ++window_;  // nothing goes on from before
  }
  for (int i = ticks_of_step_ - 1; i < path.count; i += ticks_of_step_) {
    touch_.tick(path.tools[static_cast<std::size_t>(i)], ticks_of_step_ * period_);
  }
  describe(path, slots_[turn_.writing()]);
  turn_.publish();
}

/// The places nearest to where the ball will be, if the tool goes on as it did.
void SlowBody::describe(const BodyPath& path, LocalSurface& to) noexcept {
  const BallContact& ball = touch_.ball();
  const TouchCounts& counts = touch_.counts();
  const double window = period_ * path.count;
  to.generation = path.generation;
  to.tool = path.tools[static_cast<std::size_t>(path.count - 1)];
  to.radius = ball.radius();
  to.friction = ball.friction();
  to.touches = !ball.force().isZero(0.0);
  to.slips = ball.slips();
  to.crowded = ball.crowded();
  to.most_force =
      counts.inverted == inverted_ ? std::numeric_limits<double>::max() : touch_.upright_force();
  to.inverted = inverted_ = counts.inverted;
  to.flown_apart = counts.flown_apart;
  window_ += std::exchange(flown_apart_, counts.flown_apart) == counts.flown_apart ? 0 : 1;
  const Vector3d way = to.tool - path.from;
  find_loads();
  find_near(to.tool + way, ball.radius() + 2.0 * way.norm() + body_->mesh->spacing);
  to.count = near_count_;
  for (std::size_t i = 0; i < near_count_; ++i) {
    describe_place(near_[i].sample, window, to.places[i]);
  }
  find_compliance(to);
  for (const BallContact::Place& place : ball.places()) {
    pressed_[sample_slot(place.sample)] = 0;
  }
}

void SlowBody::find_near(const Vector3d& centre, double reach) noexcept {
  const BallContact& ball = touch_.ball();
  std::size_t count = 0;
  for (std::size_t s = 0; s < near_.size(); ++s) {
    const auto sample = static_cast<std::int32_t>(s);
    const double distance = (ball.where(touch_.motion(), sample) - centre).norm();
    if (distance < reach || pressed_[s] != 0) {
      near_[count++] = {distance, sample};
    }
  }
  near_count_ = std::min(count, LocalSurface::kMost);
  const auto begin = near_.begin();
  std::partial_sort(begin, begin + static_cast<std::ptrdiff_t>(near_count_),
                    begin + static_cast<std::ptrdiff_t>(count));
}

/// Finds the loads of the ball on the last tick, by vertices; some may be there more than once.
/// Friction stays in the free part.
void SlowBody::find_loads() noexcept {
  const BallContact& ball = touch_.ball();
  load_count_ = 0;
  for (const BallContact::Place& place : ball.places()) {
    if (place.sum.isZero(0.0)) {
      continue;
    }
    pressed_[sample_slot(place.sample)] = 1;
    const SurfaceSamples::Sample& sample = ball.sample(place);
    const Vector3d force = place.sum.dot(place.normal) / touch_.steps() * place.normal;
    for (std::size_t k = 0; k < 3; ++k) {
      const double weight = sample.weight[static_cast<Eigen::Index>(k)];
      if (weight > 0.0) {
        loads_[load_count_++] = {sample.corners[k], (weight * force).cast<float>()};
      }
    }
  }
}

void SlowBody::describe_place(std::int32_t number, double window,
                              LocalSurface::Place& to) noexcept {
  const BallContact& ball = touch_.ball();
  const std::size_t s = sample_slot(number);
  to.sample = ball.samples().samples[s];
  to.rest = ball.at_rest(number);
  to.at = ball.where(touch_.motion(), number);
  to.pressed = pressed_[s] != 0;
  Vector3f moved = Vector3f::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const auto weight = static_cast<float>(to.sample.weight[static_cast<Eigen::Index>(k)]);
    for (std::size_t l = 0; l < load_count_ && weight > 0.0F; ++l) {
      const Load& load = loads_[l];
      moved += weight * (compliance_->block(to.sample.corners[k], load.vertex) * load.force);
    }
  }
  to.free = to.at - moved.cast<double>();
  to.drift.setZero();
  // A place that comes into touch jumps by what the rounds of an implicit step still lack, and a
  // jump is no drift. Its compliance alone foretells it.
  if (described_[s] + 1 == window_ && !body_->implicit) {
    to.drift = (to.free - free_[s]) / window;
  }
  described_[s] = window_;
  free_[s] = to.free;
}

void SlowBody::find_compliance(LocalSurface& to) const noexcept {
  for (std::size_t i = 0; i < to.count; ++i) {
    const SurfaceSamples::Sample& p = to.places[i].sample;
    for (std::size_t j = 0; j <= i; ++j) {
      const SurfaceSamples::Sample& q = to.places[j].sample;
      Matrix3f sum = Matrix3f::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t l = 0; l < 3; ++l) {
          const double weight =
              p.weight[static_cast<Eigen::Index>(k)] * q.weight[static_cast<Eigen::Index>(l)];
          if (weight > 0.0) {
            sum += static_cast<float>(weight) * compliance_->block(p.corners[k], q.corners[l]);
          }
        }
      }
      to.give(i, j) = sum;
      to.give(j, i) = sum.transpose();
    }
  }
}

}  // namespace haptrial::deformable
