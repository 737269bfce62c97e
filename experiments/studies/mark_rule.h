#pragma once

namespace haptrial {
class Table;
}

namespace haptrial::experiments {

/// Reads the keys of [analysis] that every protocol has, if the table is there; problems are noted.
void read_mark_rule(Table& root);

}  // namespace haptrial::experiments
