#include "core/bone/model/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace haptrial::bone {
namespace {

constexpr int kLargestReach = 250;  // voxels; its square fits 16 bits
constexpr std::uint16_t kBeyond = std::numeric_limits<std::uint16_t>::max();

/// Lines of squared distances, each replaced by min over q of line[q] + (p - q)^2.
class Envelope {
 public:
  explicit Envelope(int longest)
      : places_(static_cast<std::size_t>(longest)),
        line_(static_cast<std::size_t>(longest)),
        begins_(static_cast<std::size_t>(longest)) {}

  /// @param stride  between entries of the line
  void run(std::uint16_t* line, int length, std::size_t stride) {
    int count = 0;  // parabolas of the envelope; number n rules from begins_[n] on
    for (int q = 0; q < length; ++q) {
      line_[at(q)] = line[at(q) * stride];
      if (line_[at(q)] == kBeyond) {
        continue;
      }
      int begin = 0;
      while (count > 0) {
        begin = first_below(places_[at(count - 1)], q);
        if (begin > begins_[at(count - 1)]) {
          break;
        }
        --count;
        begin = 0;
      }
      if (begin < length) {
        places_[at(count)] = q;
        begins_[at(count)] = begin;
        ++count;
      }
    }
    if (count == 0) {
      return;
    }
    for (int p = 0, n = 0; p < length; ++p) {
      while (n + 1 < count && begins_[at(n + 1)] <= p) {
        ++n;
      }
      const int away = p - places_[at(n)];
      const int squared = line_[at(places_[at(n)])] + away * away;
      line[at(p) * stride] = static_cast<std::uint16_t>(std::min<int>(squared, kBeyond));
    }
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  /// The first place at which the parabola of q lies below that of `before` < q.
  int first_below(int before, int q) const {
    // f(q) + (p - q)^2 < f(b) + (p - b)^2  <=>  p > (f(q) + q^2 - f(b) - b^2) / (2 (q - b))
    const int over = line_[at(q)] + q * q - line_[at(before)] - before * before;
    const int under = 2 * (q - before);
    const int whole = over >= 0 ? over / under : -((-over + under - 1) / under);  // floor
    return std::max(whole + 1, 0);
  }

  std::vector<int> places_;
  std::vector<int> line_;  // as it was
  std::vector<int> begins_;
};

}  // namespace

DistanceField::DistanceField(const BoneModel& model, const std::vector<bool>& labels, double reach)
    : origin_(model.grid.origin), spacing_(model.grid.spacing), reach_(reach) {
  check(model);
  const double voxels = reach / spacing_;
  if (!(voxels >= 0.0) || voxels > kLargestReach) {
    throw std::invalid_argument("DistanceField: the reach is from 0 to 250 voxels");
  }
  const auto& size = model.grid.size;
  const auto in_set = [&](std::size_t index) {
    return model.labels[index] < labels.size() && model.labels[index] != 0 &&
           labels[model.labels[index]];
  };
  std::size_t index = 0;
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i, ++index) {
        if (in_set(index)) {
          box_.extend(Voxel(i, j, k));
        }
      }
    }
  }
  if (box_.isEmpty()) {
    return;
  }
  const int margin = static_cast<int>(std::ceil(voxels));
  box_.min() = (box_.min() - Voxel::Constant(margin)).cwiseMax(0);
  box_.max() = (box_.max() + Voxel::Constant(margin))
                   .cwiseMin(Voxel(size[0], size[1], size[2]) - Voxel::Ones());
  const Voxel extent = box_.sizes() + Voxel::Ones();
  const auto row = static_cast<std::size_t>(extent.x());
  const std::size_t plane = row * static_cast<std::size_t>(extent.y());
  squares_.assign(plane * static_cast<std::size_t>(extent.z()), kBeyond);
  std::size_t to = 0;
  for (int k = 0; k < extent.z(); ++k) {
    for (int j = 0; j < extent.y(); ++j) {
      const std::size_t from =
          model.grid.index(box_.min().x(), box_.min().y() + j, box_.min().z() + k);
      for (std::size_t i = 0; i < row; ++i, ++to) {
        squares_[to] = in_set(from + i) ? 0 : kBeyond;
      }
    }
  }
  Envelope envelope(extent.maxCoeff());
  for (int k = 0; k < extent.z(); ++k) {
    std::uint16_t* slice = squares_.data() + plane * static_cast<std::size_t>(k);
    for (int j = 0; j < extent.y(); ++j) {
      envelope.run(slice + row * static_cast<std::size_t>(j), extent.x(), 1);
    }
    for (std::size_t i = 0; i < row; ++i) {
      envelope.run(slice + i, extent.y(), row);
    }
  }
  for (std::size_t i = 0; i < plane; ++i) {
    envelope.run(squares_.data() + i, extent.z(), plane);
  }
}

std::optional<double> DistanceField::at(const Voxel& voxel) const noexcept {
  if (!box_.contains(voxel)) {
    return std::nullopt;
  }
  const Voxel extent = box_.sizes() + Voxel::Ones();
  const Voxel in = voxel - box_.min();
  const auto index = static_cast<std::size_t>(in.x()) +
                     static_cast<std::size_t>(extent.x()) *
                         (static_cast<std::size_t>(in.y()) +
                          static_cast<std::size_t>(extent.y()) * static_cast<std::size_t>(in.z()));
  const std::uint16_t squared = squares_[index];
  const double distance = spacing_ * std::sqrt(static_cast<double>(squared));
  if (squared == kBeyond || distance > reach_) {
    return std::nullopt;
  }
  return distance;
}

std::optional<double> DistanceField::linear_at(const Eigen::Vector3d& p_B) const noexcept {
  const Eigen::Array3d at = (p_B - origin_).array() / spacing_;
  if (!((at > -1e6) && (at < 1e6)).all()) {
    return std::nullopt;
  }
  const Eigen::Array3i low = at.floor().cast<int>();
  const Eigen::Array3d share = at - at.floor();
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Array3i up(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
    const double weight = (up == 1).select(share, 1.0 - share).prod();
    if (weight == 0.0) {
      continue;
    }
    const auto distance = this->at((low + up).matrix());
    if (!distance) {
      return std::nullopt;
    }
    sum += *distance * weight;
  }
  return sum;
}

std::vector<std::string> vital_structures(const BoneModel& bone) {
  std::vector<bool> there(256, false);
  for (const std::uint8_t label : bone.labels) {
    there[label] = true;
  }
  std::vector<std::string> names;
  for (std::size_t label = 1; label < bone.structures.size(); ++label) {
    const Structure& structure = bone.structures[label];
    if (structure.vital && there[label] &&
        std::find(names.begin(), names.end(), structure.name) == names.end()) {
      names.push_back(structure.name);
    }
  }
  return names;
}

std::vector<bool> labels_named(const BoneModel& bone, const std::string& name) {
  std::vector<bool> labels(bone.structures.size(), false);
  for (std::size_t label = 1; label < labels.size(); ++label) {
    labels[label] = bone.structures[label].name == name;
  }
  return labels;
}

NearestStructure nearest_structure(std::span<const std::shared_ptr<const DistanceField>> fields,
                                   const Voxel& voxel) noexcept {
  NearestStructure nearest;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto distance = fields[i]->at(voxel);
    if (distance && (nearest.structure < 0 || static_cast<float>(*distance) < nearest.distance)) {
      nearest = {static_cast<std::int32_t>(i), static_cast<float>(*distance)};
    }
  }
  return nearest;
}

}  // namespace haptrial::bone
