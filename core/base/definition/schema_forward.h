#pragma once

namespace haptrial {

// Forward declarations for headers that name tables and schemas and do not use them.
class Table;
template <class T>
class Schema;

}  // namespace haptrial
