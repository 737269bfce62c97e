#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

namespace haptrial {

/// The worth of texts that stand for numbers in a definition: "$level", "2 * $level".
///
/// A layer that knows variables derives from this class and gives it to a table with Table::with();
/// it then reads the table again before each trial. So readers know neither names nor expressions,
/// and a number that was computed is held to the same bounds, with the same sentences, as one that
/// stands in the file.
class NumberSource {
 public:
  virtual ~NumberSource() = default;
  /// @returns nothing if the text is not allowed
  /// @throws InputError saying why it has no value: a part of the sentence that is noted
  virtual std::optional<double> value_of(std::string_view text) const = 0;
  /// Three numbers, x, y and z, that a text stands for; nothing or a throw as above.
  virtual std::optional<Eigen::Vector3d> vector_of(std::string_view text) const = 0;
};

}  // namespace haptrial
