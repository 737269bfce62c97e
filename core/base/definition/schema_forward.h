#pragma once

namespace haptrial {

/// For headers that name tables and schemas of a definition and use neither.
class Table;
template <class T>
class Schema;

}  // namespace haptrial
