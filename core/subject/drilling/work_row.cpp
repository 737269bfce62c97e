#include "core/subject/drilling/work_row.h"

#include <array>
#include <utility>
#include <vector>

namespace haptrial::record {
namespace {

constexpr std::array<const char*, 4> kWords{"cortex", "middle depth", "deep", "fine burr"};

EnumText works() {
  std::vector<EnumText::Entry> entries;
  for (std::size_t n = 0; n < kWords.size(); ++n) {
    entries.push_back({static_cast<std::uint8_t>(n), kWords[n]});
  }
  return EnumText(std::move(entries));
}

}  // namespace

std::string_view word_of(subject::SurgeonWork work) noexcept {
  return kWords[static_cast<std::size_t>(work)];
}

template <>
const Table<WorkRow>& table_of<WorkRow>() {
  using R = WorkRow;
  using T = Table<R>;
  static const T table(
      {"work",
       "what a virtual surgeon worked on, a row for each change",
       37,
       RowsOf::kEndedPass,
       {"pass"}},
      {T::column("pass", &R::pass, "1", "row of /trials"),
       T::column("time", &R::time, "s", "of the procedure, earlier passes on its bone included"),
       T::word(
           "work", &R::work, kStatusBytes, works(),
           "cortex: within 3 mm below the surface that the bone had, middle depth: to 8 mm, deep, "
           "or with the fine burr what is near structures")});
  return table;
}

}  // namespace haptrial::record
