#include "core/questions/scores.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/questions/known_questionnaires.h"
#include "core/questions/question_kind.h"

namespace haptrial::questions {
namespace {

const GivenAnswer* answer_to(const std::vector<GivenAnswer>& answers, const std::string& item) {
  const auto found = std::find_if(answers.begin(), answers.end(),
                                  [&](const GivenAnswer& each) { return each.item == item; });
  return found != answers.end() ? &*found : nullptr;
}

/// The ratings in the order of kTlxScales.
std::optional<std::array<double, kTlxScales.size()>> ratings_of(
    const std::vector<GivenAnswer>& answers) {
  std::array<double, kTlxScales.size()> ratings{};
  for (std::size_t i = 0; i < ratings.size(); ++i) {
    const GivenAnswer* rating = answer_to(answers, kTlxScales[i]);
    if (rating == nullptr || !std::isfinite(rating->value)) {
      return std::nullopt;
    }
    ratings[i] = rating->value;
  }
  return ratings;
}

void add(std::vector<Score>& scores, const char* name, std::optional<double> value) {
  if (value) {
    scores.push_back({name, *value});
  }
}

}  // namespace

std::optional<double> tlx_raw(const std::vector<GivenAnswer>& answers) {
  const auto ratings = ratings_of(answers);
  if (!ratings) {
    return std::nullopt;
  }
  double sum = 0.0;
  for (const double rating : *ratings) {
    sum += rating;
  }
  return sum / static_cast<double>(ratings->size());
}

std::optional<double> tlx_weighted(const std::vector<GivenAnswer>& answers) {
  const auto ratings = ratings_of(answers);
  if (!ratings) {
    return std::nullopt;
  }
  double sum = 0.0;
  int pairs = 0;
  for (const questions::Question& item : nasa_tlx_items(true)) {
    const GivenAnswer* chosen = item.choices.empty() ? nullptr : answer_to(answers, item.name);
    const auto scale = chosen == nullptr
                           ? kTlxScales.end()
                           : std::find(kTlxScales.begin(), kTlxScales.end(), chosen->text);
    if (scale != kTlxScales.end()) {
      sum += (*ratings)[static_cast<std::size_t>(scale - kTlxScales.begin())];
      ++pairs;
    }
  }
  constexpr int kPairs = 15;
  return pairs == kPairs ? std::optional(sum / kPairs) : std::nullopt;
}

std::optional<double> laterality_quotient(const std::vector<GivenAnswer>& answers) {
  double right = 0.0;
  double left = 0.0;
  for (const questions::Question& item : edinburgh_items()) {
    const GivenAnswer* answer = answer_to(answers, item.name);
    if (answer == nullptr || !std::isfinite(answer->value)) {
      continue;
    }
    right += answer->value == 0.0 ? 1.0 : std::max(0.0, answer->value);
    left += answer->value == 0.0 ? 1.0 : std::max(0.0, -answer->value);
  }
  const double all = right + left;
  return all > 0.0 ? std::optional(100.0 * (right - left) / all) : std::nullopt;
}

std::vector<Score> scores_of(const Page& page, const std::vector<GivenAnswer>& answers) {
  std::vector<Score> scores;
  if (page.kind == PageKind::kNasaTlx) {
    add(scores, "raw", tlx_raw(answers));
    add(scores, "weighted", tlx_weighted(answers));
  } else if (page.kind == PageKind::kEdinburgh) {
    add(scores, "laterality quotient", laterality_quotient(answers));
    return scores;
  }
  for (const questions::Question& item : page.items) {
    const bool weighs = page.kind == PageKind::kNasaTlx && !item.choices.empty();
    const bool scored = item.kind->traits().scored && !weighs;
    const GivenAnswer* answer = scored ? answer_to(answers, item.name) : nullptr;
    if (answer != nullptr && std::isfinite(answer->value)) {
      scores.push_back({item.name, answer->value});
    }
  }
  return scores;
}

}  // namespace haptrial::questions
