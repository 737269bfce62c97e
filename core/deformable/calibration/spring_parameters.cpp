#include "core/deformable/calibration/spring_parameters.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "core/deformable/springs/spring_grid.h"

namespace haptrial::deformable {

const std::vector<double>& list_of(const SpringConstants& constants, SpringKind kind) {
  switch (kind) {
    case SpringKind::kLength:
      return constants.length;
    case SpringKind::kArea:
      return constants.area;
    case SpringKind::kVolume:
      break;
  }
  return constants.volume;
}

std::vector<double>& list_of(SpringConstants& constants, SpringKind kind) {
  return const_cast<std::vector<double>&>(list_of(std::as_const(constants), kind));
}

template <std::size_t n>
void SpringParameters::set_rows(SpringKind kind,
                                const std::vector<std::array<std::int32_t, n>>& springs,
                                const std::vector<std::vector<ParameterShare>>& at_vertex) {
  Rows& rows = rows_[static_cast<std::size_t>(kind)];
  for (const auto& vertices : springs) {
    std::map<std::int32_t, double> sum;
    for (const std::int32_t v : vertices) {
      for (const auto& [node, weight] : at_vertex[static_cast<std::size_t>(v)]) {
        sum[node] += weight / static_cast<double>(n);
      }
    }
    for (const auto& [node, weight] : sum) {
      rows.share.push_back({node + static_cast<std::int32_t>(first(kind)), weight});
    }
    rows.start.push_back(rows.share.size());
  }
}

SpringParameters::SpringParameters(const SpringBody& body, std::size_t nodes,
                                   const std::vector<std::vector<ParameterShare>>& at_vertex)
    : first_{0, nodes, 2 * nodes, 3 * nodes} {
  set_rows(SpringKind::kLength, body.parts.edges, at_vertex);
  set_rows(SpringKind::kArea, body.parts.faces, at_vertex);
  set_rows(SpringKind::kVolume, body.tetrahedra, at_vertex);
}

SpringParameters SpringParameters::uniform(const SpringBody& body) {
  return {body, 1, std::vector<std::vector<ParameterShare>>(body.rest.size(), {{0, 1.0}})};
}

SpringParameters SpringParameters::on_grid(const SpringBody& body,
                                           const std::array<int, 3>& nodes) {
  const SpringGrid grid(body, nodes);
  std::vector<std::vector<ParameterShare>> at_vertex;
  for (std::size_t v = 0; v < body.rest.size(); ++v) {
    std::vector<ParameterShare>& shares = at_vertex.emplace_back();
    for (const auto& [node, weight] : grid.shares(v)) {
      if (weight > 0.0) {
        shares.push_back({node, weight});
      }
    }
  }
  return {body, grid.used().size(), at_vertex};
}

SpringParameters SpringParameters::by_element(const SpringBody& body) {
  SpringParameters parameters;
  std::int32_t parameter = 0;
  for (const SpringKind kind : kSpringKinds) {
    Rows& rows = parameters.rows_[static_cast<std::size_t>(kind)];
    for (std::size_t i = 0; i < list_of(body.constants, kind).size(); ++i) {
      rows.share.push_back({parameter++, 1.0});
      rows.start.push_back(rows.share.size());
    }
    parameters.first_[static_cast<std::size_t>(kind) + 1] = static_cast<std::size_t>(parameter);
  }
  return parameters;
}

namespace {

/// Calls take(corners) for every choice of n corners of a tetrahedron, ascending.
template <std::size_t n, class Take>
void for_each_choice(geometry::Tetrahedron corners, Take take) {
  std::sort(corners.begin(), corners.end());
  for (unsigned chosen = 0; chosen < 1u << corners.size(); ++chosen) {
    if (std::popcount(chosen) != static_cast<int>(n)) {
      continue;
    }
    std::array<std::int32_t, n> choice{};
    for (std::size_t i = 0, at = 0; i < corners.size(); ++i) {
      if ((chosen >> i & 1u) != 0) {
        choice[at++] = corners[i];
      }
    }
    take(choice);
  }
}

/// Weight of the tetrahedra that have each edge or face.
template <std::size_t n>
std::vector<double> weight_around(const SpringBody& body,
                                  const std::vector<std::array<std::int32_t, n>>& springs,
                                  std::span<const double> weights) {
  std::map<std::array<std::int32_t, n>, double> around;
  for (std::size_t t = 0; t < body.tetrahedra.size(); ++t) {
    for_each_choice<n>(body.tetrahedra[t],
                       [&](const auto& corners) { around[corners] += weights[t]; });
  }
  std::vector<double> result;
  for (auto corners : springs) {
    std::sort(corners.begin(), corners.end());
    result.push_back(around.at(corners));
  }
  return result;
}

}  // namespace

SpringParameters SpringParameters::weighted(const SpringBody& body,
                                            std::span<const double> weights) const {
  const std::array<std::vector<double>, kSpringKinds.size()> around{
      weight_around(body, body.parts.edges, weights),
      weight_around(body, body.parts.faces, weights),
      {weights.begin(), weights.end()}};
  SpringParameters result = *this;
  for (std::size_t kind = 0; kind < around.size(); ++kind) {
    const std::vector<double>& w = around[kind];
    const double mean = std::accumulate(w.begin(), w.end(), 0.0) / static_cast<double>(w.size());
    Rows& rows = result.rows_[kind];
    for (std::size_t s = 0; s < w.size(); ++s) {
      for (std::size_t i = rows.start[s]; i < rows.start[s + 1]; ++i) {
        rows.share[i].weight *= w[s] / mean;
      }
    }
  }
  return result;
}

std::span<const ParameterShare> SpringParameters::shares(SpringKind kind,
                                                         std::size_t spring) const {
  const Rows& rows = rows_[static_cast<std::size_t>(kind)];
  return std::span(rows.share)
      .subspan(rows.start[spring], rows.start[spring + 1] - rows.start[spring]);
}

std::vector<double> SpringParameters::even(std::span<const double, 3> logarithms) const {
  std::vector<double> result;
  for (const SpringKind kind : kSpringKinds) {
    const auto k = static_cast<std::size_t>(kind);
    result.insert(result.end(), first_[k + 1] - first_[k], logarithms[k]);
  }
  return result;
}

SpringConstants SpringParameters::constants(std::span<const double> logarithms) const {
  std::vector<double> values;
  for (const double x : logarithms) {
    values.push_back(std::pow(10.0, x));
  }
  SpringConstants constants;
  for (const SpringKind kind : kSpringKinds) {
    std::vector<double>& list = list_of(constants, kind);
    list.assign(rows_[static_cast<std::size_t>(kind)].start.size() - 1, 0.0);
    for (std::size_t spring = 0; spring < list.size(); ++spring) {
      for (const auto& [parameter, weight] : shares(kind, spring)) {
        list[spring] += weight * values[static_cast<std::size_t>(parameter)];
      }
    }
  }
  return constants;
}

std::vector<double> SpringParameters::gradient(std::span<const double> logarithms,
                                               const SpringConstants& by_constant) const {
  std::vector<double> result(size(), 0.0);
  for (const SpringKind kind : kSpringKinds) {
    const std::vector<double>& by_spring = list_of(by_constant, kind);
    for (std::size_t spring = 0; spring < by_spring.size(); ++spring) {
      for (const auto& [parameter, weight] : shares(kind, spring)) {
        result[static_cast<std::size_t>(parameter)] += weight * by_spring[spring];
      }
    }
  }
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] *= std::numbers::ln10 * std::pow(10.0, logarithms[i]);
  }
  return result;
}

}  // namespace haptrial::deformable
