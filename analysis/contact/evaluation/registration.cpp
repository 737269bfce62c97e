#include "analysis/contact/evaluation/registration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/base/descriptive.h"
#include "core/base/random.h"

namespace haptrial::evaluation {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Points = std::vector<Eigen::Vector3d>;

constexpr double kTukey = 4.685;        // 95 % efficient for normal noise
constexpr double kSigmaOfMad = 1.4826;  // of a median of absolute normal deviations
constexpr std::size_t kSubset = 150;    // contacts that decide between starts
constexpr double kBadlyFixed = 0.01;    // of the path's size
constexpr double kHidden = 1.5;         // times the mean square: no clear difference

class PathFit {
 public:
  PathFit(const contact::SignedDistance& distance, Points contacts, double radius, double trimmed)
      : distance_(distance), contacts_(std::move(contacts)), radius_(radius), trimmed_(trimmed) {
    centre_ = Eigen::Vector3d::Zero();
    for (const auto& c : contacts_) {
      centre_ += c / static_cast<double>(contacts_.size());
    }
    double squares = 0.0;
    for (const auto& c : contacts_) {
      squares += (c - centre_).squaredNorm();
    }
    size_ = std::sqrt(squares / static_cast<double>(contacts_.size()));
  }

  const Eigen::Vector3d& centre() const { return centre_; }
  double size() const { return size_; }

  /// Refines a pose. @returns the mean square of the residuals that are kept
  double refine(Eigen::Isometry3d& pose, int steps) const;
  /// The pose after a shift, and a turn about the path's centre given as way at the distance
  /// size().
  Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const Vector6& move) const;
  /// The equations at a pose: H and g of movements about the path's centre, turns times size().
  double equations(const Eigen::Isometry3d& pose, Matrix6& h, Vector6& g) const;

 private:
  const contact::SignedDistance& distance_;
  Points contacts_;
  double radius_, trimmed_;
  Eigen::Vector3d centre_;
  double size_;
};

double PathFit::equations(const Eigen::Isometry3d& pose, Matrix6& h, Vector6& g) const {
  std::vector<contact::SurfacePoint> nearest;
  std::vector<double> sizes;
  for (const auto& c : contacts_) {
    nearest.push_back(distance_(pose * c));
    sizes.push_back(std::abs(nearest.back().distance - radius_));
  }
  const double limit = *analysis::quantile(sizes, 1.0 - trimmed_);
  const double scale =
      std::max(kTukey * kSigmaOfMad * *analysis::quantile(sizes, 0.5), 1e-12 * size_);
  h.setZero();
  g.setZero();
  double squares = 0.0, count = 0.0;
  const Eigen::Vector3d centre = pose * centre_;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    if (sizes[i] > limit) {
      continue;
    }
    const double residual = nearest[i].distance - radius_;
    const double u = std::min(1.0, sizes[i] / scale);
    const double weight = (1.0 - u * u) * (1.0 - u * u);
    Vector6 j;
    j << nearest[i].normal, (pose * contacts_[i] - centre).cross(nearest[i].normal) / size_;
    h += weight * j * j.transpose();
    g += weight * residual * j;
    squares += residual * residual;
    count += 1.0;
  }
  return squares / count;
}

Eigen::Isometry3d PathFit::moved(const Eigen::Isometry3d& pose, const Vector6& move) const {
  const Eigen::Vector3d turn = move.tail<3>() / size_;
  const Eigen::Vector3d centre = pose * centre_;
  Eigen::Isometry3d next = Eigen::Isometry3d::Identity();
  next.translate(centre + move.head<3>());
  if (turn.norm() > 0.0) {
    next.rotate(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  }
  next.translate(-centre);
  return next * pose;
}

double PathFit::refine(Eigen::Isometry3d& pose, int steps) const {
  Matrix6 h;
  Vector6 g;
  double error = equations(pose, h, g);
  double damping = 1e-6;
  for (int step = 0; step < steps; ++step) {
    Matrix6 damped = h;
    damped.diagonal().array() += damping * h.trace() + 1e-300;
    const std::optional<Eigen::MatrixXd> way = analysis::solve_positive(damped, -g);
    if (!way) {
      damping *= 10.0;
      continue;
    }
    const Vector6 move = *way;
    const Eigen::Isometry3d next = moved(pose, move);
    Matrix6 next_h;
    Vector6 next_g;
    const double next_error = equations(next, next_h, next_g);
    if (!(next_error < error)) {
      damping = std::max(10.0 * damping, 1e-6);
      if (damping > 1e3) {
        break;
      }
      continue;
    }
    const bool done = error - next_error < 1e-14 * error && move.norm() < 1e-10 * size_;
    pose = next;
    h = next_h;
    g = next_g;
    error = next_error;
    damping = std::max(0.1 * damping, 1e-12);
    if (done) {
      break;
    }
  }
  return error;
}

Eigen::Quaterniond any_orientation(RandomStream& random) {
  const Eigen::Vector4d q(random.normal(), random.normal(), random.normal(), random.normal());
  return Eigen::Quaterniond(q.normalized());
}

/// A subset at random, as errors may come back at even distances.
Points subset(std::span<const Eigen::Vector3d> contacts, RandomStream& random) {
  Points few(contacts.begin(), contacts.end());
  for (std::size_t i = 0; i < std::min(kSubset, few.size()); ++i) {
    std::swap(few[i], few[i + random.below(few.size() - i)]);
  }
  few.resize(std::min(kSubset, few.size()));
  return few;
}

Eigen::Vector3d middle_of(const contact::ContactSurface& surface) {
  Eigen::AlignedBox3d box;
  for (std::size_t slot = 0; slot < surface.triangles(); ++slot) {
    for (const auto& corner : surface.corners(static_cast<std::int32_t>(slot))) {
      box.extend(corner);
    }
  }
  return box.center();
}

/// The best of many orientations, the path's centre on the box's; each is refined a little, the
/// five best ones more.
Eigen::Isometry3d best_start(const contact::SignedDistance& distance,
                             std::span<const Eigen::Vector3d> contacts,
                             const RegistrationOptions& options) {
  if (options.starts == 0) {
    return options.guess;
  }
  RandomStream random(options.seed, "registration");
  const PathFit few(distance, subset(contacts, random), options.radius, options.trimmed);
  const Eigen::Vector3d middle = middle_of(distance.surface());
  std::vector<std::pair<double, Eigen::Isometry3d>> tried;
  for (int s = 0; s < options.starts; ++s) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(middle);
    pose.rotate(any_orientation(random));
    pose.translate(-few.centre());
    const double error = few.refine(pose, 12);
    tried.emplace_back(error, pose);
  }
  const auto less = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::sort(tried.begin(), tried.end(), less);
  tried.resize(std::min<std::size_t>(tried.size(), 5));
  for (auto& [error, pose] : tried) {
    error = few.refine(pose, 60);
  }
  return std::min_element(tried.begin(), tried.end(), less)->second;
}

std::string describe(const Vector6& direction, double distance, double before, double after) {
  const Eigen::Vector3d shift = direction.head<3>(), turn = direction.tail<3>();
  const bool turns = turn.norm() > shift.norm();
  const Eigen::Vector3d axis = (turns ? turn : shift).normalized();
  return fmt::format(
      "The contacts hardly fix a {} ({:.2f}, {:.2f}, {:.2f}) of the body: {:.2g} mm of it take "
      "the rms from {:.2g} to {:.2g} mm.",
      turns ? "turn about" : "shift along", axis.x(), axis.y(), axis.z(), 1e3 * distance,
      1e3 * before, 1e3 * after);
}

std::vector<std::string> unfixed_directions(const PathFit& fit, const Eigen::Isometry3d& pose) {
  Matrix6 h, moved_h;
  Vector6 g, moved_g;
  const double before = fit.equations(pose, h, g);
  const double distance = kBadlyFixed * fit.size(), rounding = 1e-6 * fit.size();
  const analysis::SymmetricEigen of_h = analysis::symmetric_eigen(h);
  std::vector<std::string> sentences;
  for (int d = 0; d < 6; ++d) {
    const Vector6 direction = of_h.vectors.col(d);
    double after = std::numeric_limits<double>::infinity();
    for (const double way : {-1.0, 1.0}) {
      const Eigen::Isometry3d there = fit.moved(pose, way * distance * direction);
      after = std::min(after, fit.equations(there, moved_h, moved_g));
    }
    if (after < kHidden * (before + rounding * rounding)) {
      sentences.push_back(describe(direction, distance, std::sqrt(before), std::sqrt(after)));
    }
  }
  return sentences;
}

}  // namespace

std::vector<double> surface_residuals(const contact::SignedDistance& distance,
                                      const Eigen::Isometry3d& body_from_world,
                                      std::span<const Eigen::Vector3d> contacts, double radius) {
  std::vector<double> residuals;
  for (const auto& c : contacts) {
    residuals.push_back(distance(body_from_world * c).distance - radius);
  }
  return residuals;
}

Registration register_path(const contact::SignedDistance& distance,
                           std::span<const Eigen::Vector3d> contacts,
                           const RegistrationOptions& options) {
  if (contacts.size() < 12 || distance.surface().triangles() == 0) {
    throw std::invalid_argument("a registration needs 12 contacts and a mesh with triangles");
  }
  if (!(options.trimmed >= 0.0 && options.trimmed <= 0.5) || options.starts < 0 ||
      !(options.radius >= 0.0 && std::isfinite(options.radius))) {
    throw std::invalid_argument("trimmed must be 0 to 0.5, starts and radius not negative");
  }
  for (const auto& c : contacts) {
    if (!c.allFinite()) {
      throw std::invalid_argument("contacts must be finite");
    }
  }
  Registration result;
  result.body_from_world = best_start(distance, contacts, options);
  const PathFit fit(distance, Points(contacts.begin(), contacts.end()), options.radius,
                    options.trimmed);
  result.rms = std::sqrt(fit.refine(result.body_from_world, 100));
  result.residuals = surface_residuals(distance, result.body_from_world, contacts, options.radius);
  std::vector<double> sizes;
  for (const double r : result.residuals) {
    sizes.push_back(std::abs(r));
  }
  result.median = *analysis::quantile(sizes, 0.5);
  result.p95 = *analysis::quantile(sizes, 0.95);
  result.worst = *std::max_element(sizes.begin(), sizes.end());
  result.unfixed = unfixed_directions(fit, result.body_from_world);
  return result;
}

}  // namespace haptrial::evaluation
