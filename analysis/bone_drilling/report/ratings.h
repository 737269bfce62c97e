#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace haptrial::analysis::drilling {

inline constexpr double kLowestScore = 1.0;
inline constexpr double kHighestScore = 5.0;

/// A rater's scores of a procedure. Source: Morris 2006, §3.3.1.
struct Rating {
  std::string session;  // name of the file, as Procedure::session
  int procedure{1};     // number, as Procedure::number
  std::string rater;
  double score{0.0};  // kLowestScore to kHighestScore
  std::string comment;
  bool simulated{false};  // the rater is a program

  bool operator==(const Rating&) const = default;
};

/// A table: session, procedure, rater, score, simulated, comment.
std::string ratings_csv(const std::vector<Rating>& ratings);
/// @throws InputError for what ratings_csv() does not write, among it a score out of range or a
/// rater's second score of one procedure.
std::vector<Rating> load_ratings(const std::filesystem::path& file);

/// A drilling that is to be rated.
struct RatedItem {
  std::string session;
  int procedure{1};
  /// Fingerprint of the procedure, not of its participant: items are put in order by it before they
  /// are shuffled, so that codes do not depend on names.
  std::uint64_t fingerprint{0};

  bool operator==(const RatedItem&) const = default;
};

/// Meaning of a code.
struct KeyEntry {
  std::string code;  // "K7QM"
  RatedItem item;

  bool operator==(const KeyEntry&) const = default;
};

/// Participants behind the codes, and the raters' instructions.
struct RatingKey {
  bool halves{false};             // half points are allowed
  std::vector<KeyEntry> entries;  // in the order of the sheet, by code

  bool operator==(const RatingKey&) const = default;
};

/// Codes of four letters and digits, none of which looks like another. Their stream follows from
/// the seed and all fingerprints: a sheet of another study, or of the study before a procedure was
/// added to it, has codes that are unknown here.
/// @throws InputError for two items of one session and number.
RatingKey blinded(std::vector<RatedItem> items, std::uint64_t seed, bool halves);

/// The key as a text that says nothing to a reader. It keeps the raters' eyes away, not a
/// cryptanalyst's: whoever has this program can open it.
std::string sealed(const RatingKey& key);
/// @param name  of the file, for sentences
/// @throws InputError where the text is not a sealed key, or was changed.
RatingKey opened(const std::string& text, const std::string& name);

/// The sheet that a rater fills in: code, score, comment. Lines that start with '#' say how.
std::string rating_sheet(const RatingKey& key);
/// A rater's filled-in sheet; the rater's name is the file's, without its ending.
/// @throws InputError with one sentence for the first line that is wrong: an unknown code, a code
/// twice or missing, no score, one that is not from 1 to 5 in whole or, where allowed, half points.
std::vector<Rating> read_sheet(const std::filesystem::path& file, const RatingKey& key);

}  // namespace haptrial::analysis::drilling
