#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/definition/bounds.h"

namespace haptrial {
class Table;
struct NumberOrText;
}  // namespace haptrial

namespace haptrial::scene {

/// Where the numbers of a field come from: from the definition as they stand there. Where a number
/// is allowed a text may stand ("$level", "2 * $level"), and for a vector one text or texts among
/// its numbers; what they are worth is asked of the two virtual functions.
///
/// A layer that knows variables derives from this class and reads the fields again before each
/// trial. So fields know neither names nor expressions, and a number that was computed is held to
/// the same bounds, with the same sentences, as one that stands in the file.
class NumberSource {
 public:
  virtual ~NumberSource() = default;

  /// Required values. Where a problem is noted some value comes back: within the bounds for a
  /// number, zero for a vector or matrix.
  double number(Table& table, std::string_view key, const Bounds& bounds,
                std::string_view unit) const;
  Eigen::Vector3d vector(Table& table, std::string_view key, const Bounds& bounds,
                         std::string_view unit) const;
  /// A list of places: [[x, y, z], …], or texts that stand for one each.
  std::vector<Eigen::Vector3d> vectors(Table& table, std::string_view key, const Bounds& bounds,
                                       std::string_view unit) const;
  /// By rows, [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]].
  Eigen::Matrix3d matrix(Table& table, std::string_view key, const Bounds& bounds,
                         std::string_view unit) const;

 protected:
  /// Whether a text may stand for a number.
  virtual bool takes_texts() const { return false; }
  /// What a text is worth; nothing if no text is allowed.
  /// @throws InputError saying why this one has no value: a part of the sentence that is noted
  virtual std::optional<double> value_of(std::string_view text) const;
  virtual std::optional<Eigen::Vector3d> vector_of(std::string_view text) const;

 private:
  std::optional<Eigen::Vector3d> place(Table& table, std::string_view key, std::string_view text,
                                       const Bounds& bounds, std::string_view allowed) const;
  std::optional<Eigen::Vector3d> row(Table& table, std::string_view key,
                                     const std::vector<NumberOrText>& entries, const Bounds& bounds,
                                     std::string_view unit, std::string_view allowed) const;
  std::optional<double> entry(Table& table, std::string_view key, std::string_view text,
                              const Bounds& bounds, std::string_view unit) const;
};

}  // namespace haptrial::scene
