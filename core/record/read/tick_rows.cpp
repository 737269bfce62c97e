#include "core/record/read/tick_rows.h"

#include <fmt/format.h>

#include "core/base/error.h"

namespace haptrial::record {

RowSpan span_of_pass(const SessionReader& reader, const PassRow& pass) {
  const bool any = pass.first_sample <= pass.last_sample;
  const std::uint64_t count = any ? pass.last_sample - pass.first_sample + 1 : 0;
  const RowSpan span =
      any ? span_of_ticks(reader, samples_table(), pass.first_sample, count) : RowSpan{};
  if (span.count != count || count == 0) {
    throw InputError(
        fmt::format("{}: of the {} ticks of trial {}, {} are in the file; choose a "
                    "trial whose samples are all there",
                    reader.path().string(), count, pass.trial, span.count));
  }
  return span;
}

}  // namespace haptrial::record
