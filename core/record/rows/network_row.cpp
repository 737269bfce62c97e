#include "core/record/rows/network_row.h"

#include "core/record/table/schema.h"

namespace haptrial::record {

template <>
const Table<NetworkRow>& table_of<NetworkRow>() {
  using R = NetworkRow;
  using T = Table<R>;
  static const T table({"networks",
                        "the simulated network that a pass went over, each way",
                        24,
                        RowsOf::kSession,
                        {"pass"}},
                       {T::column("pass", &R::pass, "1", "row of /trials"),
                        T::text("name", &R::name, kConditionBytes, "as the definition calls it"),
                        T::column("delay", &R::delay, "s", "least"),
                        T::column("jitter", &R::jitter, "s", "mean of what comes on top"),
                        T::column("loss", &R::loss, "1", "share of messages"),
                        T::column("duplication", &R::duplication, "1", "likewise"),
                        T::column("reordering", &R::reordering, "1", "likewise"),
                        T::column("bandwidth", &R::bandwidth, "1", "bytes a second; 0: no limit")});
  return table;
}

}  // namespace haptrial::record
