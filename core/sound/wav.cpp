#include "core/sound/wav.h"

#include <fmt/format.h>
#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/whole_file.h"

namespace haptrial::sound {
namespace {

struct CloseFile {
  void operator()(SNDFILE* file) const { sf_close(file); }
};
using File = std::unique_ptr<SNDFILE, CloseFile>;

}  // namespace

std::vector<Recording> read_channels(const std::filesystem::path& file) {
  refuse_special_file(file);
  SF_INFO info{};
  const File source(sf_open(file.c_str(), SFM_READ, &info));
  if (!source) {
    throw InputError(
        fmt::format("{}: cannot be read ({}); allowed: a sound file (.wav, .flac, .aiff)",
                    file.string(), sf_strerror(nullptr)));
  }
  constexpr sf_count_t kLongest = 3600;  // [s]
  if (info.frames < 1 || info.frames > kLongest * info.samplerate || info.channels < 1) {
    throw InputError(fmt::format("{}: has {} samples; allowed: from 1 sample to an hour of samples",
                                 file.string(), info.frames));
  }
  const auto count = static_cast<std::size_t>(info.channels);
  std::vector<Recording> channels(count, {static_cast<double>(info.samplerate), {}});
  for (Recording& channel : channels) {
    channel.samples.reserve(static_cast<std::size_t>(info.frames));
  }
  constexpr sf_count_t kFrames = 16'384;
  std::vector<float> frames(static_cast<std::size_t>(kFrames * info.channels));
  while (const sf_count_t read = sf_readf_float(source.get(), frames.data(), kFrames)) {
    for (std::size_t i = 0; i < count * static_cast<std::size_t>(read); ++i) {
      std::vector<float>& samples = channels[i % count].samples;
      if (!std::isfinite(frames[i])) {
        throw InputError(
            fmt::format("{}: sample {} is not a finite number; remove it from the recording",
                        file.string(), samples.size()));
      }
      samples.push_back(frames[i]);
    }
  }
  return channels;
}

Recording read_recording(const std::filesystem::path& file) {
  std::vector<Recording> channels = read_channels(file);
  Recording mean = std::move(channels.front());
  for (std::size_t i = 0; i < mean.samples.size(); ++i) {
    for (std::size_t channel = 1; channel < channels.size(); ++channel) {
      mean.samples[i] += channels[channel].samples[i];
    }
    mean.samples[i] /= static_cast<float>(channels.size());
  }
  return mean;
}

struct WavWriter::Impl {
  WholeFile out;
  File sink{};
  std::vector<short> values{};
};

WavWriter::WavWriter(std::filesystem::path file, int rate, bool overwrite)
    : impl_(new Impl{.out = WholeFile(std::move(file), overwrite)}) {
  impl_->out.close();
  SF_INFO info{};
  info.samplerate = rate;
  info.channels = 1;
  info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_16;
  impl_->sink.reset(sf_open(impl_->out.part().c_str(), SFM_WRITE, &info));
  if (!impl_->sink) {
    throw InputError(
        fmt::format("{}: cannot be created ({}); choose a folder with write permission",
                    impl_->out.file().string(), sf_strerror(nullptr)));
  }
}

WavWriter::~WavWriter() = default;

void WavWriter::write(std::span<const float> samples) {
  constexpr float kFull = 32'767.0F;
  impl_->values.clear();
  for (const float sample : samples) {
    impl_->values.push_back(
        static_cast<short>(std::lround(kFull * std::clamp(sample, -1.0F, 1.0F))));
  }
  const auto count = static_cast<sf_count_t>(samples.size());
  if (sf_write_short(impl_->sink.get(), impl_->values.data(), count) != count) {
    throw RunError(
        fmt::format("{}: {}", impl_->out.file().string(), sf_strerror(impl_->sink.get())));
  }
}

void WavWriter::finish() {
  if (sf_close(impl_->sink.release()) != 0) {
    throw RunError(fmt::format("{}: cannot be written completely", impl_->out.file().string()));
  }
  impl_->out.finish();
}

SoundTrack::SoundTrack(const std::filesystem::path& file, double rate, SpectrumTable table,
                       const ThinBone& thin, std::uint64_t seed, bool overwrite, Mix mix)
    : rate_(rate),
      sound_(std::move(table), thin, seed),
      writer_(file, static_cast<int>(DrillSound::kRate), overwrite),
      mix_(std::move(mix)) {
  if (!(rate > 0.0 && rate <= DrillSound::kRate)) {
    throw std::invalid_argument("SoundTrack: the rate of the states must be from 0 to 48,000 Hz");
  }
}

void SoundTrack::add(const DrillState& drill) {
  sound_.set(drill);
  ++states_;
  const auto end =
      static_cast<std::uint64_t>(static_cast<double>(states_) * DrillSound::kRate / rate_);
  buffer_.clear();
  for (; samples_ < end; ++samples_) {
    buffer_.push_back(sound_.next());
  }
  if (mix_) {
    mix_(buffer_);
  }
  writer_.write(buffer_);
}

}  // namespace haptrial::sound
