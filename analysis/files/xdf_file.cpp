#include "analysis/files/xdf_file.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "core/base/file_text.h"

namespace haptrial::exchange {
namespace {

static_assert(std::endian::native == std::endian::little, "the format is little-endian");

// Tags of chunks (https://github.com/sccn/xdf/wiki/Specifications).
constexpr std::uint16_t kFileHeader = 1, kStreamHeader = 2, kSamples = 3, kClockOffset = 4,
                        kStreamFooter = 6;
constexpr std::size_t kChunk = std::size_t{1} << 16;  // of samples [bytes]
constexpr std::size_t kPiece = std::size_t{1} << 20;  // that is written at once [bytes]

template <class Number>
void add_number(std::string& text, Number number) {
  char bytes[sizeof(Number)];
  std::memcpy(bytes, &number, sizeof(Number));
  text.append(bytes, sizeof(Number));
}

/// A length in 4 bytes, after the number of these bytes.
void add_length(std::string& text, std::size_t length) {
  text += '\x04';
  add_number(text, static_cast<std::uint32_t>(length));
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    result += c == '&'                               ? "&amp;"
              : c == '<'                             ? "&lt;"
              : c == '>'                             ? "&gt;"
              : byte < ' ' && c != '\n' && c != '\t' ? std::string(" ")
                                                     : std::string(1, c);
  }
  return result;
}

std::string element(std::string_view name, std::string_view text) {
  return fmt::format("<{0}>{1}</{0}>", name, escaped(text));
}

const char* name_of(XdfFormat format) {
  return format == XdfFormat::kFloat32    ? "float32"
         : format == XdfFormat::kDouble64 ? "double64"
                                          : "string";
}

std::string header_of(const XdfStream& stream) {
  std::string xml = "<?xml version=\"1.0\"?><info>";
  xml += element("name", stream.name) + element("type", stream.type);
  xml += element("channel_count", std::to_string(stream.channels.size()));
  xml += element("nominal_srate", fmt::format("{}", stream.rate));
  xml += element("channel_format", name_of(stream.format));
  xml += element("source_id", "haptrial " + stream.name) + "<desc>";
  if (!stream.description.empty()) {
    xml += element("description", stream.description);
  }
  xml += "<channels>";
  for (const XdfChannel& channel : stream.channels) {
    xml += "<channel>" + element("label", channel.label) + element("unit", channel.unit) +
           element("type", stream.type) + "</channel>";
  }
  return xml + "</channels></desc></info>";
}

}  // namespace

XdfFile::XdfFile(const std::filesystem::path& path,
                 const std::vector<std::pair<std::string, std::string>>& about)
    : path_(path) {
  write_text(path_, "XDF:");
  std::string xml = "<?xml version=\"1.0\"?><info><version>1.0</version>";
  for (const auto& [name, text] : about) {
    xml += element(name, text);
  }
  add_chunk(kFileHeader, xml + "</info>");
}

void XdfFile::add_chunk(std::uint16_t tag, std::string_view content) {
  add_length(text_, sizeof(tag) + content.size());
  add_number(text_, tag);
  text_ += content;
  if (text_.size() >= kPiece) {
    append_text(path_, text_);
    text_.clear();
  }
}

std::uint32_t XdfFile::add_stream(const XdfStream& stream) {
  streams_.push_back({stream.format, stream.channels.size()});
  const auto number = static_cast<std::uint32_t>(streams_.size());
  std::string content;
  add_number(content, number);
  add_chunk(kStreamHeader, content + header_of(stream));
  return number;
}

XdfFile::State& XdfFile::begin_sample(std::uint32_t stream, double time) {
  State& state = streams_.at(stream - 1);
  state.first = state.samples == 0 ? time : state.first;
  state.last = time;
  state.pending += '\x08';  // bytes of the time
  add_number(state.pending, time);
  return state;
}

void XdfFile::end_sample(std::uint32_t stream) {
  State& state = streams_[stream - 1];
  ++state.samples;
  ++state.pending_samples;
  if (state.pending.size() >= kChunk) {
    flush(stream);
  }
}

void XdfFile::flush(std::uint32_t stream) {
  State& state = streams_[stream - 1];
  if (state.pending_samples == 0) {
    return;
  }
  std::string content;
  add_number(content, stream);
  add_length(content, state.pending_samples);
  content += state.pending;
  add_chunk(kSamples, content);
  state.pending.clear();
  state.pending_samples = 0;
}

void XdfFile::add(std::uint32_t stream, double time, std::span<const double> values) {
  const State& known = streams_.at(stream - 1);
  if (values.size() != known.channels || known.format == XdfFormat::kString) {
    throw std::invalid_argument("XdfFile::add: a sample has other channels than its stream");
  }
  State& state = begin_sample(stream, time);
  for (const double value : values) {
    if (state.format == XdfFormat::kFloat32) {
      add_number(state.pending, static_cast<float>(value));
    } else {
      add_number(state.pending, value);
    }
  }
  end_sample(stream);
}

void XdfFile::add(std::uint32_t stream, double time, const std::string& text) {
  const State& known = streams_.at(stream - 1);
  if (known.channels != 1 || known.format != XdfFormat::kString) {
    throw std::invalid_argument("XdfFile::add: a text is no sample of this stream");
  }
  State& state = begin_sample(stream, time);
  add_length(state.pending, text.size());
  state.pending += text;
  end_sample(stream);
}

void XdfFile::close() {
  for (std::uint32_t stream = 1; stream <= streams_.size(); ++stream) {
    flush(stream);
    const State& state = streams_[stream - 1];
    for (const double time : {state.first, state.last}) {
      if (std::isfinite(time)) {  // no offset: the clock is the recorder's own
        std::string offset;
        add_number(offset, stream);
        add_number(offset, time);
        add_number(offset, 0.0);
        add_chunk(kClockOffset, offset);
      }
    }
    std::string content;
    add_number(content, stream);
    content += "<?xml version=\"1.0\"?><info>";
    if (state.samples > 0) {
      content += element("first_timestamp", fmt::format("{}", state.first)) +
                 element("last_timestamp", fmt::format("{}", state.last));
    }
    content += element("sample_count", std::to_string(state.samples)) + "</info>";
    add_chunk(kStreamFooter, content);
  }
  append_text(path_, text_);
  text_.clear();
}

}  // namespace haptrial::exchange
