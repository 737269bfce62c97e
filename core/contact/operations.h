#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace haptrial::contact {

/// Counted operations of a renderer since it was started: the same on every machine, other than its
/// time. Plain integers of the thread that renders.
struct Operations {
  std::uint64_t ticks{0};
  std::uint64_t sweeps{0};            // straight ways of a proxy, each against all triangles
  std::uint64_t triangles_tested{0};  // one at a time, exactly: a sweep's meeting, a plane's depth
  std::uint64_t triangles_passed{0};  // of a list, passed over by a bound
  std::uint64_t lists{0};             // of triangles around the proxy, gathered from the hierarchy
  std::uint64_t long_sweeps{0};       // through the whole hierarchy: beyond the list
  std::uint64_t nearest_searches{0};  // nearest points of the mesh, through the hierarchy
  std::uint64_t plane_solutions{0};   // points nearest to a goal on one, two or three planes
  std::uint64_t cells{0};             // of a grid, looked up

  friend bool operator==(const Operations&, const Operations&) = default;
};

/// All counts but the ticks, each with its name.
struct OperationCount {
  std::string_view name;
  std::uint64_t Operations::*count;
};
inline constexpr std::array kOperationCounts{
    OperationCount{"sweeps", &Operations::sweeps},
    OperationCount{"triangles tested", &Operations::triangles_tested},
    OperationCount{"triangles passed over", &Operations::triangles_passed},
    OperationCount{"lists gathered", &Operations::lists},
    OperationCount{"long sweeps", &Operations::long_sweeps},
    OperationCount{"nearest-point searches", &Operations::nearest_searches},
    OperationCount{"plane solutions", &Operations::plane_solutions},
    OperationCount{"cells", &Operations::cells},
};

}  // namespace haptrial::contact
