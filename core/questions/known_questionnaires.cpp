#include "core/questions/known_questionnaires.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "core/questions/question_kinds.h"

namespace haptrial::questions {
namespace {

using questions::Question;

struct TlxScale {
  const char* title;
  const char* question;
};

constexpr std::array<TlxScale, kTlxScales.size()> kTlxTexts{{
    {"Mental demand", "How mentally demanding was the task?"},
    {"Physical demand", "How physically demanding was the task?"},
    {"Temporal demand", "How hurried or rushed was the pace of the task?"},
    {"Performance", "How successful were you in accomplishing what you were asked to do?"},
    {"Effort", "How hard did you have to work to accomplish your level of performance?"},
    {"Frustration", "How insecure, discouraged, irritated, stressed and annoyed were you?"},
}};

struct Activity {
  const char* name;
  const char* question;
};

constexpr std::array<Activity, 10> kActivities{{
    {"writing", "Writing"},
    {"drawing", "Drawing"},
    {"throwing", "Throwing"},
    {"scissors", "Scissors"},
    {"toothbrush", "Toothbrush"},
    {"knife", "Knife (without fork)"},
    {"spoon", "Spoon"},
    {"broom", "Broom (upper hand)"},
    {"match", "Striking a match (the match)"},
    {"box", "Opening a box (the lid)"},
}};

Question rating(std::size_t scale) {
  Question item;
  item.name = kTlxScales[scale];
  item.kind = &questions::scale_kind();
  item.title = kTlxTexts[scale].title;
  item.text = kTlxTexts[scale].question;
  item.high = 100.0;
  item.step = 5.0;
  const bool performance = item.name == "performance";
  item.low_end = performance ? "Perfect" : "Very low";
  item.high_end = performance ? "Failure" : "Very high";
  return item;
}

Question pair(std::size_t first, std::size_t second) {
  Question item;
  item.name = fmt::format("{} or {}", kTlxScales[first], kTlxScales[second]);
  item.text = "Which contributed more to the workload of the task?";
  item.choices = {{kTlxScales[first], kTlxTexts[first].title, 1.0},
                  {kTlxScales[second], kTlxTexts[second].title, 2.0}};
  return item;
}

}  // namespace

std::vector<Question> nasa_tlx_items(bool weighted) {
  std::vector<Question> items;
  for (std::size_t scale = 0; scale < kTlxScales.size(); ++scale) {
    items.push_back(rating(scale));
  }
  for (std::size_t first = 0; weighted && first < kTlxScales.size(); ++first) {
    for (std::size_t second = first + 1; second < kTlxScales.size(); ++second) {
      items.push_back(pair(first, second));
    }
  }
  return items;
}

std::vector<Question> edinburgh_items() {
  std::vector<Question> items;
  for (const Activity& activity : kActivities) {
    Question item;
    item.name = activity.name;
    item.title = activity.question;
    item.text = "Which hand do you prefer to use?";
    item.choices = {
        {"always left", "Left; the other only if I am forced to", -2.0},
        {"left", "Left", -1.0},
        {"either", "Either hand", 0.0},
        {"right", "Right", 1.0},
        {"always right", "Right; the other only if I am forced to", 2.0},
        {"never done", "I have no experience of it", std::numeric_limits<double>::quiet_NaN()}};
    items.push_back(std::move(item));
  }
  return items;
}

}  // namespace haptrial::questions
