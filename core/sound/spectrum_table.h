#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial::sound {

/// The kinds of burr that sound different. Source: Morris 2006, §3.2.9.
enum class Burr { kDiamond, kCutting };
inline constexpr std::array kBurrs{Burr::kDiamond, Burr::kCutting};
std::string_view name_of(Burr burr);  // "diamond", "cutting"

/// One line of a spectrum: a noisy harmonic.
struct Peak {
  double frequency{0.0};  // >= 0 [Hz]
  double amplitude{0.0};  // of the sine >= 0 [full scale, or N]
  double bandwidth{0.0};  // full width at half the power >= 0 [Hz]
};

/// Lines and what lies between them. Plain data of fixed size: it goes through a latest-value
/// channel and is interpolated on the servo thread.
struct Spectrum {
  static constexpr int kMaxPeaks = 24;
  std::array<Peak, kMaxPeaks> peaks{};
  int count{0};       // of peaks in use
  double noise{0.0};  // root mean square of the white rest >= 0 [as the amplitudes]
};

/// Blend from one spectrum to another: weight 0 gives the first, 1 the second. The i-th line glides
/// to the i-th; a line that the other lacks keeps its frequency and fades. Any thread.
Spectrum blend(const Spectrum& first, const Spectrum& second, double weight) noexcept;

/// A spectrum as it was recorded, or made up, at one force.
struct Level {
  std::string name;      // "light"; letters, digits, '-' and '_'
  double force{0.0};     // with which the burr presses on bone >= 0 [N]
  bool measured{false};  // false: a stand-in
  Spectrum spectrum{};
};

inline constexpr const char* kFullScale = "full scale";
inline constexpr const char* kNewton = "N";

/// How a drill sounds, or shakes the hand that holds it, by burr, contact and force.
/// Source: Morris 2006, §3.2.3.8 and §3.2.9.
struct SpectrumTable {
  struct Kind {
    std::vector<Level> free;     // turning in the air: none or one
    std::vector<Level> contact;  // on bone, by rising force
  };
  std::string source;  // where the numbers come from, in a sentence
  std::string unit;    // of the amplitudes: kFullScale (of sound) or kNewton (of vibration)
  std::array<Kind, kBurrs.size()> kinds;

  const Kind& of(Burr burr) const { return kinds[static_cast<std::size_t>(burr)]; }
  Kind& of(Burr burr) { return kinds[static_cast<std::size_t>(burr)]; }

  /// Spectrum of a burr that presses with `force` [N]: between two levels interpolated, outside the
  /// nearest. A burr without levels sounds as the other one does, a drill without a level in the
  /// air as its lightest contact, and the other way round. Servo thread: no allocation, lock or
  /// throw.
  Spectrum at(Burr burr, bool contact, double force) const noexcept;
};

/// @throws std::invalid_argument naming what breaks a bound above, when there is no level at all,
/// or contact levels do not rise in force.
void check(const SpectrumTable& table);

/// The text of a TOML file, such as read_spectrum_table() reads.
std::string to_toml(const SpectrumTable& table);

/// @throws InputError with a sentence for each problem in the file.
SpectrumTable read_spectrum_table(const std::filesystem::path& file);
SpectrumTable parse_spectrum_table(std::string_view text, std::string_view file_name);

/// Table that is used if no file is given. All levels of the vibration and all but one of the sound
/// are stand-ins, as their `measured` says: the source prints its spectra without numbers.
SpectrumTable default_sound();
SpectrumTable default_vibration();

}  // namespace haptrial::sound
