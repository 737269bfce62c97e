#include "analysis/bone_drilling/report/ratings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "analysis/files/csv.h"
#include "analysis/files/delimited.h"
#include "core/base/error.h"
#include "core/base/fnv.h"
#include "core/base/random.h"

namespace haptrial::analysis::drilling {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kSealed = "haptrial rating key, sealed; haptrial rate import opens it\n";
constexpr std::uint64_t kSealSeed = 0x5ea1;
constexpr int kHexBase = 16;

std::string code_of(RandomStream& random) {
  constexpr std::string_view kSigns = "ABCDEFGHJKMNPQRTUVWXY346789";  // none looks like another
  constexpr int kLength = 4;
  std::string code;
  for (int i = 0; i < kLength; ++i) {
    code += kSigns[random.below(kSigns.size())];
  }
  return code;
}

// Twice gives the text back.
std::string masked(std::string text) {
  RandomStream stream(kSealSeed, "rating key");
  for (char& c : text) {
    c = static_cast<char>(static_cast<unsigned char>(c) ^ (stream.bits() & 0xffU));
  }
  return text;
}

std::string what_is_allowed(bool halves) {
  return halves ? "1 to 5, in whole or half points" : "1, 2, 3, 4 or 5";
}

double score_of(const CsvTable& table, std::size_t row, std::size_t column, bool halves) {
  std::string text(table.text(row, column));
  std::replace(text.begin(), text.end(), ',', '.');
  const bool number = !text.empty() && text.size() <= 4 && text[0] != '.' &&
                      text.find_first_not_of("0123456789.") == std::string::npos &&
                      std::count(text.begin(), text.end(), '.') <= 1;
  const double score = number ? std::stod(text) : 0.0;
  const double steps = halves ? 2.0 * score : score;
  if (!number || !(score >= kLowestScore && score <= kHighestScore) || steps != std::floor(steps)) {
    table.refuse(row, column, what_is_allowed(halves));
  }
  return score;
}

int whole_number(const CsvTable& table, std::size_t row, std::size_t column, int low, int high) {
  const std::string text(table.text(row, column));
  constexpr std::size_t kLongest = 9;
  const bool digits =
      !text.empty() && text.size() <= kLongest &&
      std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  const int number = digits ? std::stoi(text) : low - 1;
  if (number < low || number > high) {
    table.refuse(row, column, fmt::format("a whole number from {} to {}", low, high));
  }
  return number;
}

}  // namespace

std::string ratings_csv(const std::vector<Rating>& ratings) {
  std::string text = "session,procedure,rater,score,simulated,comment\n";
  for (const Rating& r : ratings) {
    exchange::RowText row(text, exchange::Delimited::kCsv);
    row.add(r.session).add(r.procedure).add(r.rater).add(r.score);
    row.add(r.simulated ? 1 : 0).add(r.comment).end();
  }
  return text;
}

std::vector<Rating> load_ratings(const std::filesystem::path& file) {
  const CsvTable table = CsvTable::load(file);
  constexpr int kMostProcedures = 999'999;
  const std::size_t session = table.column("session"), procedure = table.column("procedure");
  const std::size_t rater = table.column("rater"), score = table.column("score");
  const std::size_t simulated = table.column("simulated"), comment = table.column("comment");
  std::vector<Rating> ratings;
  std::set<std::tuple<std::string, int, std::string>> seen;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    Rating r;
    r.session = table.text(row, session);
    r.procedure = whole_number(table, row, procedure, 1, kMostProcedures);
    r.rater = table.text(row, rater);
    r.score = table.numbers(score)[row];
    r.simulated = whole_number(table, row, simulated, 0, 1) == 1;
    r.comment = table.text(row, comment);
    if (!(r.score >= kLowestScore && r.score <= kHighestScore)) {
      table.refuse(row, score, "1 to 5");
    }
    if (!seen.emplace(r.session, r.procedure, r.rater).second) {
      table.refuse(row, rater, "each rater once for a procedure");
    }
    ratings.push_back(std::move(r));
  }
  return ratings;
}

RatingKey blinded(std::vector<RatedItem> items, std::uint64_t seed, bool halves) {
  std::sort(items.begin(), items.end(), [](const RatedItem& a, const RatedItem& b) {
    return std::tie(a.fingerprint, a.session, a.procedure) <
           std::tie(b.fingerprint, b.session, b.procedure);
  });
  std::set<std::pair<std::string, int>> seen;
  for (const RatedItem& item : items) {
    if (!seen.emplace(item.session, item.procedure).second) {
      throw InputError(fmt::format("{}: has procedure {} twice; keep one of them", item.session,
                                   item.procedure));
    }
  }
  Fnv1a study;
  study.add(seed);
  for (const RatedItem& item : items) {
    study.add(item.fingerprint);
  }
  RandomStream order(study.value(), "rating order"), letters(study.value(), "rating codes");
  for (std::size_t i = items.size(); i > 1; --i) {
    std::swap(items[i - 1], items[order.below(i)]);
  }
  RatingKey key{.halves = halves, .entries = {}};
  std::set<std::string> codes;
  for (RatedItem& item : items) {
    std::string code = code_of(letters);
    while (!codes.insert(code).second) {
      code = code_of(letters);
    }
    key.entries.push_back({std::move(code), std::move(item)});
  }
  std::sort(key.entries.begin(), key.entries.end(),
            [](const KeyEntry& a, const KeyEntry& b) { return a.code < b.code; });
  return key;
}

std::string sealed(const RatingKey& key) {
  Json json{{"halves", key.halves}, {"entries", Json::array()}};
  for (const KeyEntry& e : key.entries) {
    json["entries"].push_back({{"code", e.code},
                               {"session", e.item.session},
                               {"procedure", e.item.procedure},
                               {"fingerprint", e.item.fingerprint}});
  }
  const std::string plain = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string text(kSealed);
  text += fmt::format("{:016x}\n", fnv1a(plain));
  constexpr std::size_t kBytesALine = 40;
  const std::string hidden = masked(plain);
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    text += fmt::format("{:02x}", static_cast<unsigned char>(hidden[i]));
    text += (i + 1) % kBytesALine == 0 || i + 1 == hidden.size() ? "\n" : "";
  }
  return text;
}

RatingKey opened(const std::string& text, const std::string& name) {
  const InputError damaged(fmt::format(
      "{}: is not a rating key as haptrial rate prepare wrote it, or was changed", name));
  if (text.compare(0, kSealed.size(), kSealed) != 0) {
    throw damaged;
  }
  std::string digits;
  std::copy_if(text.begin() + static_cast<std::ptrdiff_t>(kSealed.size()), text.end(),
               std::back_inserter(digits), [](char c) { return c != '\n'; });
  constexpr std::size_t kHashDigits = 16;
  if (digits.size() < kHashDigits || digits.size() % 2 != 0 ||
      digits.find_first_not_of("0123456789abcdef") != std::string::npos) {
    throw damaged;
  }
  std::string hidden;
  for (std::size_t i = kHashDigits; i < digits.size(); i += 2) {
    hidden += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, kHexBase));
  }
  const std::string plain = masked(hidden);
  if (fnv1a(plain) != std::stoull(digits.substr(0, kHashDigits), nullptr, kHexBase)) {
    throw damaged;
  }
  try {
    const Json json = Json::parse(plain);
    RatingKey key{.halves = json.at("halves").get<bool>(), .entries = {}};
    for (const Json& e : json.at("entries")) {
      key.entries.push_back({e.at("code").get<std::string>(),
                             {e.at("session").get<std::string>(), e.at("procedure").get<int>(),
                              e.at("fingerprint").get<std::uint64_t>()}});
    }
    return key;
  } catch (const Json::exception&) {
    throw damaged;
  }
}

std::string rating_sheet(const RatingKey& key) {
  std::string text = fmt::format(
      "# One line for each procedure: its code, a score and, if you like, a comment.\n"
      "# Scores: {}. See instructions.txt. Name the file after yourself.\n"
      "code,score,comment\n",
      what_is_allowed(key.halves));
  for (const KeyEntry& entry : key.entries) {
    text += fmt::format("{},,\n", entry.code);
  }
  return text;
}

std::vector<Rating> read_sheet(const std::filesystem::path& file, const RatingKey& key) {
  const CsvTable table = CsvTable::load(file);
  const std::size_t code = table.column("code"), score = table.column("score");
  std::vector<Rating> ratings;
  std::set<std::string> seen;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string found(table.text(row, code));
    const auto entry = std::find_if(key.entries.begin(), key.entries.end(),
                                    [&](const KeyEntry& e) { return e.code == found; });
    if (entry == key.entries.end()) {
      table.refuse(row, code, "a code of this study's sheet");
    }
    if (!seen.insert(found).second) {
      table.refuse(row, code, "each code once");
    }
    Rating r{entry->item.session, entry->item.procedure, file.stem().string(), 0.0, {}, false};
    r.score = score_of(table, row, score, key.halves);
    r.comment = table.has("comment") ? table.text(row, table.column("comment")) : "";
    ratings.push_back(std::move(r));
  }
  for (const KeyEntry& entry : key.entries) {
    if (seen.count(entry.code) == 0) {
      throw InputError(fmt::format("{}: code {} has no line; write a line for each of the {} codes",
                                   file.string(), entry.code, key.entries.size()));
    }
  }
  return ratings;
}

}  // namespace haptrial::analysis::drilling
