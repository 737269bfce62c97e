#include "analysis/force_training/judge/skill_fit.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "analysis/statistics/base/distributions.h"
#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kResamples = 999;
constexpr std::size_t kFewestPeople = 4;
constexpr double kLevel = 0.05;
constexpr double kWidest = 0.5;  // interval of a share that is still called determined

/// Sums over curves from which a fit follows, so that people can be left out and drawn again.
struct Sums {
  double n{0.0}, y{0.0};
  Vector3d x{Vector3d::Zero()}, xy{Vector3d::Zero()};
  Matrix3d xx{Matrix3d::Zero()};

  void add(const Sums& other, double times) {
    n += times * other.n;
    y += times * other.y;
    x += times * other.x;
    xy += times * other.xy;
    xx += times * other.xx;
  }
};

/// Predicted judgement a - w · part.
struct Fit {
  double a{0.0};
  Vector3d w{Vector3d::Zero()};
};

/// Least squares with w >= 0: the best of the fits to each subset of the parts that keep to it.
Fit fit(const Sums& s) {
  const Matrix3d spread = s.xx - s.x * s.x.transpose() / s.n;
  const Vector3d falls = s.x * s.y / s.n - s.xy;  // minus the covariance
  Fit best{s.y / s.n, Vector3d::Zero()};
  double most = 0.0;  // sum of squares explained
  for (unsigned subset = 1; subset < 8; ++subset) {
    Matrix3d own = Matrix3d::Identity();
    Vector3d right = Vector3d::Zero();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if ((subset >> i & 1U) != 0 && (subset >> j & 1U) != 0) {
          own(i, j) = spread(i, j);
        }
      }
      right[i] = (subset >> i & 1U) != 0 ? falls[i] : 0.0;
    }
    const Vector3d w = own.ldlt().solve(right);
    const double explained = w.dot(right);
    if (w.allFinite() && w.minCoeff() >= 0.0 && explained > most) {
      most = explained;
      best = {(s.y + w.dot(s.x)) / s.n, w};
    }
  }
  return best;
}

/// The curves of one participant.
struct Person {
  std::vector<std::size_t> curves;
  Sums sums;
};

class Curves {
 public:
  Curves(const Eigen::MatrixX3d& parts, std::span<const std::size_t> people) : parts_(parts) {
    std::map<std::size_t, std::vector<std::size_t>> by_person;
    for (std::size_t i = 0; i < people.size(); ++i) {
      by_person[people[i]].push_back(i);
    }
    for (auto& [person, curves] : by_person) {
      people_.push_back({std::move(curves), {}});
    }
  }

  const std::vector<Person>& people() const { return people_; }

  void judge(std::span<const double> judged) {
    all_ = {};
    for (Person& person : people_) {
      person.sums = {};
      for (const std::size_t curve : person.curves) {
        const Vector3d x = parts_.row(static_cast<Eigen::Index>(curve));
        person.sums.add({1.0, judged[curve], x, judged[curve] * x, x * x.transpose()}, 1.0);
      }
      all_.add(person.sums, 1.0);
    }
  }
  Fit fit_all() const { return fit(all_); }

  /// Squared errors of each participant left out: of the fit to the others and of their mean.
  std::vector<std::array<double, 2>> errors(std::span<const double> judged) const {
    std::vector<std::array<double, 2>> errors;
    for (const Person& person : people_) {
      Sums others = all_;
      others.add(person.sums, -1.0);
      const Fit of_others = fit(others);
      std::array<double, 2> own{0.0, 0.0};
      for (const std::size_t curve : person.curves) {
        const Vector3d x = parts_.row(static_cast<Eigen::Index>(curve));
        const double error = judged[curve] - (of_others.a - of_others.w.dot(x));
        const double from_mean = judged[curve] - others.y / others.n;
        own[0] += error * error;
        own[1] += from_mean * from_mean;
      }
      errors.push_back(own);
    }
    return errors;
  }
  /// The fit to participants that are drawn again, and the places of those drawn.
  Fit fit_drawn(RandomStream& random, std::vector<std::size_t>& drawn) const {
    Sums sums;
    drawn.clear();
    for (std::size_t i = 0; i < people_.size(); ++i) {
      drawn.push_back(random.below(people_.size()));
      sums.add(people_[drawn.back()].sums, 1.0);
    }
    return fit(sums);
  }

 private:
  const Eigen::MatrixX3d& parts_;
  std::vector<Person> people_;
  Sums all_;
};

double r_squared(const std::vector<std::array<double, 2>>& errors) {
  double error = 0.0, from_mean = 0.0;
  for (const auto& [own, mean] : errors) {
    error += own;
    from_mean += mean;
  }
  return from_mean > 0.0 ? 1.0 - error / from_mean : 0.0;
}

/// Participants drawn again differ less than others would, by n - 1 to n in the variance, and as if
/// their spread were known: ratio of the interval that Student's t gives to that of the quantiles.
double widening(std::size_t people) {
  const auto n = static_cast<double>(people);
  return t_quantile(0.975, n - 1.0) / normal_quantile(0.975) * std::sqrt(n / (n - 1.0));
}

/// The interval of an estimate from the central 95 % of its values among participants drawn again,
/// which are put in order; it lies above `least` and below 1.
std::array<double, 2> interval(std::vector<double>& values, double estimate, std::size_t people,
                               double least) {
  std::ranges::sort(values);
  const auto end = [&](double share) {
    const auto at = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5);
    return estimate + widening(people) * (values[at] - estimate);
  };
  return {std::clamp(end(0.025), least, estimate), std::clamp(end(0.975), estimate, 1.0)};
}

Vector3d shares_of(const Fit& fit) {
  const double sum = fit.w.sum();
  return sum > 0.0 ? Vector3d(fit.w / sum) : Vector3d(Vector3d::Zero());
}

void add_intervals(const Curves& curves, const std::vector<std::array<double, 2>>& errors,
                   std::uint64_t seed, SkillFit& result) {
  RandomStream random(seed, "judged participants");
  std::vector<double> explained;
  std::array<std::vector<double>, 3> shares;
  std::vector<std::size_t> drawn;
  for (int i = 0; i < kResamples; ++i) {
    const Vector3d own = shares_of(curves.fit_drawn(random, drawn));
    std::vector<std::array<double, 2>> again;
    for (const std::size_t person : drawn) {
      again.push_back(errors[person]);
    }
    explained.push_back(r_squared(again));
    for (std::size_t j = 0; j < 3; ++j) {
      shares[j].push_back(own[static_cast<Eigen::Index>(j)]);
    }
  }
  std::tie(result.low, result.high) = std::tuple_cat(
      interval(explained, result.r_squared, result.people, -std::numeric_limits<double>::max()));
  for (std::size_t j = 0; j < 3; ++j) {
    JudgedShare& share = result.shares[j];
    std::tie(share.low, share.high) =
        std::tuple_cat(interval(shares[j], share.value, result.people, 0.0));
  }
}

template <class T>
void shuffle(std::vector<T>& values, RandomStream& random) {
  for (std::size_t k = values.size(); k > 1; --k) {
    std::swap(values[k - 1], values[random.below(k)]);
  }
}

/// Share of shuffles whose R² is as high, the judgements themselves among them. Curves of one
/// participant are alike, and so are their judgements, whether or not these follow the parts: the
/// means of participants are exchanged, and deviations from a mean within a participant.
double shuffled_p(Curves curves, std::span<const double> judged, double found, std::uint64_t seed) {
  RandomStream random(seed, "judgements shuffled");
  std::vector<double> means;
  std::vector<std::vector<double>> deviations;
  for (const Person& person : curves.people()) {
    means.push_back(person.sums.y / person.sums.n);
    auto& own = deviations.emplace_back();
    for (const std::size_t curve : person.curves) {
      own.push_back(judged[curve] - means.back());
    }
  }
  std::vector<double> shuffled(judged.size());
  int as_high = 1;
  for (int i = 0; i < kResamples; ++i) {
    shuffle(means, random);
    for (std::size_t person = 0; person < means.size(); ++person) {
      shuffle(deviations[person], random);
      const auto& own = curves.people()[person].curves;
      for (std::size_t k = 0; k < own.size(); ++k) {
        shuffled[own[k]] = means[person] + deviations[person][k];
      }
    }
    curves.judge(shuffled);
    as_high += r_squared(curves.errors(shuffled)) >= found;
  }
  return static_cast<double>(as_high) / (kResamples + 1);
}

std::string verdict_of(const SkillFit& result) {
  if (!result.predicts) {
    return "The judgements do not determine the shares: the parts of the score predict those of "
           "participants left out no better than shuffled ones.";
  }
  return result.determined
             ? "The parts of the score predict the judgements of participants left out, and the "
               "judgements determine the shares."
             : "The parts of the score predict the judgements of participants left out, but the "
               "judgements do not determine every share: an interval is wider than 0.5. More "
               "curves or judges may; parts that rise and fall together cannot be told apart.";
}

}  // namespace

Defined<SkillFit> fit_skill(const Eigen::MatrixX3d& parts, std::span<const double> judged,
                            std::span<const std::size_t> people, std::uint64_t seed) {
  if (static_cast<std::size_t>(parts.rows()) != judged.size() || people.size() != judged.size()) {
    throw std::invalid_argument("fit_skill: parts, judgements and people differ in number");
  }
  Curves curves(parts, people);
  if (curves.people().size() < kFewestPeople) {
    return Undefined{fmt::format("it takes curves of {} participants, and there are {}",
                                 kFewestPeople, curves.people().size())};
  }
  if (std::ranges::min(judged) == std::ranges::max(judged)) {
    return Undefined{"all judgements are alike"};
  }
  curves.judge(judged);
  SkillFit result;
  result.curves = judged.size();
  result.people = curves.people().size();
  const Vector3d shares = shares_of(curves.fit_all());
  for (std::size_t j = 0; j < 3; ++j) {
    result.shares[j].value = shares[static_cast<Eigen::Index>(j)];
  }
  const auto errors = curves.errors(judged);
  result.r_squared = r_squared(errors);
  add_intervals(curves, errors, seed, result);
  result.p = shuffled_p(curves, judged, result.r_squared, seed);
  result.predicts = result.p < kLevel && result.r_squared > 0.0;
  result.determined =
      result.predicts && std::ranges::all_of(result.shares, [](const JudgedShare& share) {
        return share.high - share.low <= kWidest;
      });
  result.verdict = verdict_of(result);
  return result;
}

}  // namespace haptrial::analysis
