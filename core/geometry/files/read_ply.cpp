#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include "core/geometry/files/mesh_text_internal.h"

namespace haptrial::geometry::reading {
namespace {

enum class Type : std::uint8_t { kI8, kU8, kI16, kU16, kI32, kU32, kF32, kF64 };

struct TypeName {
  std::string_view name;
  Type type;
};
constexpr std::array<TypeName, 16> kTypes{{{"char", Type::kI8},
                                           {"int8", Type::kI8},
                                           {"uchar", Type::kU8},
                                           {"uint8", Type::kU8},
                                           {"short", Type::kI16},
                                           {"int16", Type::kI16},
                                           {"ushort", Type::kU16},
                                           {"uint16", Type::kU16},
                                           {"int", Type::kI32},
                                           {"int32", Type::kI32},
                                           {"uint", Type::kU32},
                                           {"uint32", Type::kU32},
                                           {"float", Type::kF32},
                                           {"float32", Type::kF32},
                                           {"double", Type::kF64},
                                           {"float64", Type::kF64}}};

constexpr std::size_t size_of(Type type) {
  constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

struct Property {
  std::string name;
  Type type{Type::kF32};
  std::optional<Type> count;  // of a list
};

struct Element {
  std::string name;
  std::int64_t rows{0};
  std::vector<Property> properties;
};

enum class Coding { kText, kLittle, kBig };

struct Head {
  Coding coding{Coding::kText};
  std::vector<Element> elements;
};

class HeadReader {
 public:
  explicit HeadReader(Text& text) : text_(text) {}

  Head read() {
    expect(text_.word_below("ply"), "ply");
    while (true) {
      const std::string_view word = text_.next_line() ? text_.word() : "";
      if (word == "end_header") {
        break;
      }
      statement(word);
    }
    if (!coded_) {
      text_.fail("the header ends without a format");
    }
    return std::move(head_);
  }

 private:
  void statement(std::string_view word) {
    if (word == "format") {
      const std::string_view name = text_.word();
      coded_ = true;
      if (name == "ascii") {
        head_.coding = Coding::kText;
      } else if (name == "binary_little_endian") {
        head_.coding = Coding::kLittle;
      } else if (name == "binary_big_endian") {
        head_.coding = Coding::kBig;
      } else {
        text_.fail(
            fmt::format("the format is {}; allowed: ascii, binary_little_endian, binary_big_endian",
                        in_quotes(name)));
      }
    } else if (word == "element") {
      Element element;
      element.name = text_.word();
      element.rows = text_.whole(text_.word(), "the number of an element");
      if (element.rows < 0) {
        text_.fail(fmt::format("the number of an element is {}; allowed: 0 or more", element.rows));
      }
      head_.elements.push_back(element);
    } else if (word == "property") {
      property();
    } else if (word != "comment" && word != "obj_info") {
      text_.fail(
          word.empty()
              ? "the file ends in its header"
              : fmt::format("found {}; allowed: format, comment, element, property, end_header",
                            in_quotes(word)));
    }
  }

  void property() {
    if (head_.elements.empty()) {
      text_.fail("a property stands before the first element");
    }
    Property property;
    std::string_view word = text_.word();
    if (word == "list") {
      property.count = type(text_.word());
      if (*property.count == Type::kF32 || *property.count == Type::kF64) {
        text_.fail("the length of a list is a float; allowed: a whole number");
      }
      word = text_.word();
    }
    property.type = type(word);
    property.name = text_.word();
    head_.elements.back().properties.push_back(property);
  }

  Type type(std::string_view word) const {
    for (const TypeName& known : kTypes) {
      if (known.name == word) {
        return known.type;
      }
    }
    text_.fail(fmt::format(
        "a property has the type {}; allowed: char, uchar, short, ushort, int, uint, float, double",
        in_quotes(word)));
  }

  void expect(std::string_view found, std::string_view word) {
    if (found != word) {
      text_.fail(fmt::format("the file begins with {}; allowed: {}", in_quotes(found), word));
    }
  }

  Text& text_;
  Head head_;
  bool coded_{false};
};

/// The numbers behind the head, one after the other.
class Numbers {
 public:
  Numbers(Text& text, std::string_view bytes, std::string_view name, Coding coding)
      : text_(text), bytes_(bytes), name_(name), coding_(coding), at_(text.position()) {}

  double next(Type type) {
    if (coding_ == Coding::kText) {
      return text_number();
    }
    const std::size_t size = size_of(type);
    if (bytes_.size() - at_ < size) {
      fail("the file ends before its last element");
    }
    std::array<char, 8> raw{};
    std::memcpy(raw.data(), bytes_.data() + at_, size);
    at_ += size;
    if (coding_ == Coding::kBig) {
      std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size));
    }
    return decoded(raw, type);
  }

  void skip(Type type, std::int64_t count) {
    if (coding_ != Coding::kText) {
      if (count > room(size_of(type))) {
        fail("the file ends before its last element");
      }
      at_ += size_of(type) * static_cast<std::size_t>(count);
      return;
    }
    for (std::int64_t i = 0; i < count; ++i) {
      text_.word_below("a number");
    }
  }

  /// @returns how many values of this type the rest of the file can hold.
  std::int64_t room(std::size_t size) const {
    const std::size_t left =
        coding_ == Coding::kText ? (text_.bytes_left() + 1) / 2 : (bytes_.size() - at_) / size;
    return static_cast<std::int64_t>(left);
  }
  std::size_t least_bytes(Type type) const { return coding_ == Coding::kText ? 2 : size_of(type); }

  [[noreturn]] void fail(const std::string& sentence) const {
    if (coding_ == Coding::kText) {
      text_.fail(sentence);
    }
    throw InputError(fmt::format("{}: at byte {}: {}", name_, at_, sentence));
  }

 private:
  double text_number() {
    const std::string_view word = text_.word_below("a number");
    return text_.coordinate(word, "a value");
  }

  template <class T>
  static double as(const std::array<char, 8>& raw) {
    T value;
    std::memcpy(&value, raw.data(), sizeof value);
    return static_cast<double>(value);
  }

  static double decoded(const std::array<char, 8>& raw, Type type) {
    static_assert(std::endian::native == std::endian::little);
    switch (type) {
      case Type::kI8:
        return as<std::int8_t>(raw);
      case Type::kU8:
        return as<std::uint8_t>(raw);
      case Type::kI16:
        return as<std::int16_t>(raw);
      case Type::kU16:
        return as<std::uint16_t>(raw);
      case Type::kI32:
        return as<std::int32_t>(raw);
      case Type::kU32:
        return as<std::uint32_t>(raw);
      case Type::kF32:
        return as<float>(raw);
      case Type::kF64:
        return as<double>(raw);
    }
    return 0.0;
  }

  Text& text_;
  std::string_view bytes_;
  std::string_view name_;
  Coding coding_;
  std::size_t at_;
};

class Ply {
 public:
  Ply(Text& text, std::string_view bytes, std::string_view name)
      : head_(HeadReader(text).read()),
        numbers_(text, bytes, name, head_.coding),
        text_(text),
        name_(name) {}

  Mesh read() && {
    check_head();
    for (const Element& element : head_.elements) {
      check_room(element);
      if (element.properties.empty()) {
        continue;
      }
      for (std::int64_t row = 0; row < element.rows; ++row) {
        if (element.name == "vertex") {
          read_vertex(element);
        } else if (element.name == "face") {
          read_face(element);
        } else {
          skip(element);
        }
      }
    }
    return std::move(mesh_).take(name_);
  }

 private:
  void check_head() {
    bool corners = false;
    for (const Element& element : head_.elements) {
      if (element.name == "vertex") {
        if (vertices_ > 0) {
          text_.fail("the header has two vertex elements");
        }
        vertices_ = element.rows;
        for (const char* axis : {"x", "y", "z"}) {
          const auto is_axis = [&](const Property& p) { return p.name == axis && !p.count; };
          if (std::count_if(element.properties.begin(), element.properties.end(), is_axis) != 1) {
            text_.fail(fmt::format("the vertices need one property {}", axis));
          }
        }
      } else if (element.name == "face") {
        corners = std::any_of(element.properties.begin(), element.properties.end(), is_corners);
      }
    }
    if (!corners) {
      const bool strips =
          std::ranges::find(head_.elements, "tristrips", &Element::name) != head_.elements.end();
      text_.fail(strips ? "the surface is given as strips of triangles; convert it to faces"
                        : "the file has no faces with a list vertex_indices");
    }
  }

  static bool is_corners(const Property& property) {
    return property.count && (property.name == "vertex_indices" || property.name == "vertex_index");
  }

  void check_room(const Element& element) {
    std::size_t least = 0;
    for (const Property& property : element.properties) {
      least += numbers_.least_bytes(property.count.value_or(property.type));
    }
    const std::int64_t most = least == 0 ? element.rows : numbers_.room(least);
    if (element.rows > most || element.rows > std::numeric_limits<std::int32_t>::max()) {
      numbers_.fail(
          fmt::format("the header states {} rows of {}; the file has bytes for {} at most",
                      element.rows, in_quotes(element.name), most));
    }
    if (element.name == "vertex") {
      mesh_.reserve(static_cast<std::uint64_t>(element.rows), 0);
    }
  }

  void read_vertex(const Element& element) {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (const Property& property : element.properties) {
      if (property.count) {
        skip(property);
        continue;
      }
      const bool is_axis =
          property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z';
      if (!is_axis) {
        numbers_.skip(property.type, 1);
        continue;
      }
      const double value = numbers_.next(property.type);
      if (const std::string problem = coordinate_problem(value); !problem.empty()) {
        numbers_.fail(problem);
      }
      point[property.name[0] - 'x'] = value;
    }
    mesh_.add_vertex(point);
  }

  void read_face(const Element& element) {
    for (const Property& property : element.properties) {
      if (is_corners(property)) {
        read_corners(property);
      } else {
        skip(property);
      }
    }
  }

  void read_corners(const Property& property) {
    const std::int64_t count = length(property);
    if (count < 1) {
      numbers_.fail(fmt::format("a face has {} corners; allowed: 3 or more", count));
    }
    corners_.clear();
    for (std::int64_t i = 0; i < count; ++i) {
      const double index = numbers_.next(property.type);
      if (!(index >= 0.0) || index >= static_cast<double>(vertices_) ||
          index != std::floor(index)) {
        numbers_.fail(
            fmt::format("a face has the corner {}; allowed: 0 to {}", index, vertices_ - 1));
      }
      corners_.push_back(static_cast<std::int32_t>(index));
    }
    mesh_.add_face(corners_);
  }

  std::int64_t length(const Property& property) {
    const double count = numbers_.next(*property.count);
    const std::int64_t most = numbers_.room(size_of(property.type));
    if (!(count >= 0.0) || count > static_cast<double>(most) || count != std::floor(count)) {
      numbers_.fail(fmt::format("a list has {} values; allowed: 0 to {}, which the file has left",
                                count, most));
    }
    return static_cast<std::int64_t>(count);
  }

  void skip(const Property& property) {
    numbers_.skip(property.type, property.count ? length(property) : 1);
  }

  void skip(const Element& element) {
    for (const Property& property : element.properties) {
      skip(property);
    }
  }

  Head head_;
  Numbers numbers_;
  Text& text_;
  std::string_view name_;
  Gathering mesh_;
  std::int64_t vertices_{0};
  std::vector<std::int32_t> corners_;
};

}  // namespace

Mesh read_ply(std::string_view bytes, std::string_view name, const WorkReport& report) {
  Text text(bytes, name, report);
  text.set_comment(0);
  return Ply(text, bytes, name).read();
}

}  // namespace haptrial::geometry::reading
