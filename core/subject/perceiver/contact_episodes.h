#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "core/base/point_state.h"
#include "core/subject/perceiver/felt.h"

namespace haptrial::subject {

/// Mean of the greater values of a signal: of those that it had during the greater half of the
/// time. The rise of a push and a short impact do not count. Values are gathered in bins of at most
/// 1/16 of their size, each with its own mean, so that a steady signal comes out exactly.
/// Servo thread.
class UpperMean {
 public:
  void clear() noexcept { *this = UpperMean{}; }
  /// @param value  0 to 1,000; beyond counts as the next of them
  void add(double value, double duration) noexcept;
  double mean() const noexcept;  // 0 if nothing was added

 private:
  static constexpr int kPerOctave = 16;
  static constexpr int kLowest = -10;  // below 2^kLowest is one bin
  static constexpr int kOctaves = 20;
  struct Bin {
    double time{0.0};
    double sum{0.0};
  };
  std::array<Bin, 1 + kPerOctave * kOctaves> bins_;
};

/// The hand's contacts in an interval, as physical quantities: f is the force on the hand, p and v
/// its position and velocity; in contact |f| is above contact_force, moving |v| above moving_speed.
///
///     force       mean of |f| over the greater half of the time in contact (UpperMean)
///     stiffness   -slope of n·f over n·p in the longest contact, n the axis of most force
///     viscosity   slope over |v| of the force r = -f·v/|v| that resists, while moving
///     friction    ∫ r |v| dt / ∫ |v| dt, while moving: what springs give back does not count
///     roughness   root mean square of f less its slow part (first order, 50 ms), moving in contact
///     extent      greatest way between the places where contacts began, after the first; with one
///                 contact the way to it; without any the greatest way from the start
///     unevenness  root mean square, over the way in contact, of the distance from the sphere that
///                 fits the touched places best (algebraic fit, Kåsa 1976); 0 without a way
///     contrast    greatest stiffness of the contacts (the first 16 with a slope) over their
///     median;
///                 1 with fewer than two
///     frequency   of the sine whose change from tick to tick has the same ratio to its size, root
///                 mean squares, as that of f less its slow part; 0 where that is below 10 mN
///     mass        -∫ f·a dt / ∫ a·a dt, both behind the same filter (first order, 10 ms)
///     duration    from the first tick in contact to the last; without any since the start
///
/// Slopes are least-squares lines with an offset. Servo thread: no allocation, lock, I/O or throw.
class ContactEpisodes {
 public:
  explicit ContactEpisodes(const SenseParameters& senses) noexcept;

  void begin() noexcept;
  /// A tick. @param force  on the hand, in W [N]; @param dt  > 0 [s]. Not finite: left out.
  void feel(const Eigen::Vector3d& force, const PointState& hand, double dt) noexcept;

  double force() const noexcept { return upper_.mean(); }  // [N]
  double stiffness() const noexcept;                       // >= 0, 0 in free air [N/m]
  double viscosity() const noexcept;                       // >= 0 [N·s/m]
  double friction() const noexcept;                        // >= 0 [N]
  double roughness() const noexcept;                       // [N]
  double extent() const noexcept;                          // [m]
  double unevenness() const noexcept;                      // [m]
  double contrast() const noexcept;                        // >= 1
  double frequency() const noexcept;                       // >= 0 [Hz]
  double mass() const noexcept;                            // >= 0 [kg]
  double duration() const noexcept;                        // [s]
  double resistance() const noexcept;                      // mean r while moving [N]
  ContactEpisode met(Quantity quantity) const noexcept;

 private:
  /// Weighted sums of a line y = a + b x.
  struct Line {
    double weight{0.0}, x{0.0}, y{0.0}, xx{0.0}, xy{0.0};
    void add(double px, double py, double w) noexcept;
    double slope(double least_variance) const noexcept;  // through the origin if x hardly varies
  };
  /// The same of vectors.
  struct Cloud {
    double weight{0.0};
    Eigen::Vector3d p{Eigen::Vector3d::Zero()}, f{Eigen::Vector3d::Zero()};
    Eigen::Matrix3d pp{Eigen::Matrix3d::Zero()}, pf{Eigen::Matrix3d::Zero()},
        ff{Eigen::Matrix3d::Zero()};
  };
  /// Sums for the sphere |p|² = 2 c·p + (r² - |c|²), weighted by the way.
  struct Ball {
    void add(const Eigen::Vector3d& p, double way) noexcept;
    double weight{0.0}, squares{0.0};                // of |p|²
    Eigen::Vector4d right{Eigen::Vector4d::Zero()};  // Σ (p, 1) |p|²
    Eigen::Matrix4d left{Eigen::Matrix4d::Zero()};   // Σ (p, 1)(p, 1)'
  };
  /// Sums over the part of the force that is not slow, at rest and in motion.
  struct Fluctuation {
    void add(const Eigen::Vector3d& force, double dt) noexcept;
    Eigen::Vector3d slow{Eigen::Vector3d::Zero()}, fast{Eigen::Vector3d::Zero()};  // [N]
    double age{0.0}, period{0.0};                                                  // [s]
    double squares{0.0}, changes{0.0};  // of the fast part and of its change a tick [N² s]
  };
  /// Sums over force and acceleration behind one filter.
  struct Pushing {
    void add(const Eigen::Vector3d& force, const Eigen::Vector3d& v, double dt) noexcept;
    Eigen::Vector3d before{Eigen::Vector3d::Zero()};  // v a tick ago [m/s]
    Eigen::Vector3d force{Eigen::Vector3d::Zero()}, acceleration{Eigen::Vector3d::Zero()};
    double age{0.0}, fa{0.0}, aa{0.0};
  };
  double stiffness_of(const Cloud& cloud) const noexcept;
  void touch(const Eigen::Vector3d& force, const Eigen::Vector3d& p, double dt) noexcept;
  void move(const Eigen::Vector3d& force, const Eigen::Vector3d& v, bool touching,
            double dt) noexcept;
  void follow(const Eigen::Vector3d& p, bool touching, double dt) noexcept;

  double contact_force_;
  double moving_speed_;
  UpperMean upper_;
  Cloud cloud_;                           // of the present contact
  Cloud longest_;                         // of those before it
  std::array<double, 16> stiffnesses_{};  // of those before it [N/m]
  std::size_t stiffness_count_{0};
  Ball ball_;
  Line line_;
  double lost_{0.0}, way_{0.0};                    // ∫ r |v| dt [J], ∫ |v| dt [m]
  Eigen::Vector3d slow_{Eigen::Vector3d::Zero()};  // [N]
  double slow_age_{0.0};                           // in contact and moving [s]
  double fluctuation_{0.0}, rough_time_{0.0};
  Fluctuation throughout_;
  Pushing pushing_;
  double time_{0.0}, first_touch_{-1.0}, last_touch_{0.0};  // since the start [s]
  Eigen::Vector3d start_{Eigen::Vector3d::Zero()}, first_{Eigen::Vector3d::Zero()};
  double farthest_{0.0};  // from the start [m]
  double apart_{0.0};     // contacts from the first [m]
  double free_for_{0.0};  // since the last contact [s]
  int contacts_{0};
  bool begun_{false};
};

}  // namespace haptrial::subject
