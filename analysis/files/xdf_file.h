#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace haptrial::exchange {

/// How a stream holds its values.
enum class XdfFormat { kFloat32, kDouble64, kString };

struct XdfChannel {
  std::string label;
  std::string unit;  // "" for a pure number
};

struct XdfStream {
  std::string name;
  std::string type;  // as programs sort streams: "Markers"
  XdfFormat format{XdfFormat::kFloat32};
  double rate{0.0};  // nominal [Hz]; 0: irregular
  std::vector<XdfChannel> channels;
  std::string description{};  // of the whole stream
};

/// Writes a file of the Extensible Data Format, version 1.0, piece by piece: streams of numbers or
/// texts, each sample with its time. All times are of one clock, as the offsets in the file say.
/// Memory does not grow with the file. One thread at a time.
class XdfFile {
 public:
  /// @param about  pairs of names and texts for the file's header, names being those of XML
  /// elements
  /// @throws RunError when the file cannot be written, as every member does
  XdfFile(const std::filesystem::path& path,
          const std::vector<std::pair<std::string, std::string>>& about);

  /// Adds a stream; call before its samples. @returns its number
  std::uint32_t add_stream(const XdfStream& stream);

  /// Adds a sample of a stream of numbers. @param values  (channels)
  /// @throws std::invalid_argument for another number of values, or a stream of texts
  void add(std::uint32_t stream, double time, std::span<const double> values);
  /// Adds a sample of a stream of texts with one channel. @throws std::invalid_argument otherwise
  void add(std::uint32_t stream, double time, const std::string& text);

  /// Writes what is left and the footers; call once.
  void close();

 private:
  struct State {
    XdfFormat format;
    std::size_t channels;
    std::uint64_t samples{0};
    double first{std::numeric_limits<double>::quiet_NaN()};
    double last{std::numeric_limits<double>::quiet_NaN()};
    std::string pending{};  // samples of the chunk that is not written yet
    std::uint32_t pending_samples{0};
  };
  State& begin_sample(std::uint32_t stream, double time);
  void end_sample(std::uint32_t stream);
  void flush(std::uint32_t stream);
  void add_chunk(std::uint16_t tag, std::string_view content);

  std::filesystem::path path_;
  std::vector<State> streams_;  // number 1 is the first
  std::string text_;            // not yet on the disk
};

}  // namespace haptrial::exchange
