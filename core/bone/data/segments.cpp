#include "core/bone/data/segments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <set>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/bone/data/anatomy.h"

namespace haptrial::bone {
namespace {

constexpr std::size_t kMostSegments = 255;  // labels are bytes

struct Segment {
  int number{0};  // in its keys
  std::size_t layer{0};
  std::uint8_t value{0};  // in its layer
  bool plain{false};      // bone without a name of its own
};

/// A whole number from 0 on, or -1.
int number_in(std::string_view words) {
  int number = -1;
  const auto [end, error] = std::from_chars(words.data(), words.data() + words.size(), number);
  return error == std::errc() && end == words.data() + words.size() && number >= 0 ? number : -1;
}

std::string key_of(int segment, const char* what) {
  return fmt::format("Segment{}_{}", segment, what);
}

/// The number of a key "SegmentN_LabelValue"; -1 for any other key.
int segment_of(const std::string& key) {
  constexpr std::string_view kBefore = "Segment", kAfter = "_LabelValue";
  if (!key.starts_with(kBefore) || !key.ends_with(kAfter)) {
    return -1;
  }
  return number_in(key.substr(kBefore.size(), key.size() - kBefore.size() - kAfter.size()));
}

/// In the order of their numbers, which has gaps where a segment was deleted.
std::vector<Segment> segments_in(const std::string& name, const VolumeHead& head) {
  const auto value = [&](int segment, const char* what) {
    const auto found = head.keys.find(key_of(segment, what));
    return found == head.keys.end() ? std::string() : found->second;
  };
  std::set<int> numbers;
  for (const auto& [key, words] : head.keys) {
    if (const int number = segment_of(key); number >= 0) {
      numbers.insert(number);
    }
  }
  std::vector<Segment> segments;
  for (const int number : numbers) {
    const int label = number_in(value(number, "LabelValue"));
    const std::string words = value(number, "Layer");
    const int layer = words.empty() ? 0 : number_in(words);
    if (label < 1 || label > static_cast<int>(kMostSegments) || layer < 0 ||
        layer >= head.components || segments.size() >= kMostSegments) {
      throw InputError(fmt::format(
          "{}: segment {} has value '{}' in layer '{}'; allowed: values 1 to 255 in "
          "layers 0 to {}, {} segments at most",
          name, number, value(number, "LabelValue"), words, head.components - 1, kMostSegments));
    }
    segments.push_back({number, static_cast<std::size_t>(layer), static_cast<std::uint8_t>(label),
                        structure_named(value(number, "Name"), 0).name == kPlainBone});
  }
  return segments;
}

}  // namespace

bool names_segments(const std::map<std::string, std::string>& keys) {
  return std::ranges::any_of(keys, [](const auto& key) { return segment_of(key.first) >= 0; });
}

void join_layers(const std::string& name, SourceVolume& source) {
  VolumeHead& head = source.head;
  if (head.components == 1) {
    return;
  }
  const std::vector<Segment> segments = segments_in(name, head);
  const auto layers = static_cast<std::size_t>(head.components);
  std::vector<std::array<std::uint8_t, 256>> numbers(layers);  // of segments, by layer and value
  for (std::size_t s = 0; s < segments.size(); ++s) {
    numbers[segments[s].layer][segments[s].value] = static_cast<std::uint8_t>(s + 1);
  }
  BigArray<float> joined(head.count());
  std::size_t shared = 0;
  for (std::size_t at = 0; at < joined.size(); ++at) {
    std::uint8_t best = 0;
    int held = 0;
    for (std::size_t layer = 0; layer < layers; ++layer) {
      const float value = source.values[at * layers + layer];
      const bool label = value >= 1.0F && value <= 255.0F;
      const std::uint8_t number = label ? numbers[layer][static_cast<std::uint8_t>(value)] : 0;
      if (number == 0) {
        continue;
      }
      ++held;
      const bool yields = best != 0 && segments[number - 1U].plain;
      const bool stronger = best == 0 || segments[best - 1U].plain || number > best;
      best = stronger && !yields ? number : best;
    }
    shared += held > 1 ? 1 : 0;
    joined[at] = best;
  }
  for (std::size_t s = 0; s < segments.size(); ++s) {
    head.keys[key_of(segments[s].number, "LabelValue")] = fmt::format("{}", s + 1);
    head.keys[key_of(segments[s].number, "Layer")] = "0";
  }
  head.format += fmt::format(", {} layers", head.components);
  if (shared > 0) {
    head.format += fmt::format(" that share {} voxels", shared);
  }
  head.components = 1;
  source.values = std::move(joined);
}

}  // namespace haptrial::bone
