#include "core/deformable/springs/star_packs.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "core/deformable/springs/part_index.h"

namespace haptrial::deformable {
namespace {

using geometry::Tetrahedron;

constexpr std::size_t kStarCorners = 8;
constexpr std::size_t kSingleCorners = 4;
constexpr std::size_t kPerVoxel = 5;    // tetrahedra that tetrahedralize() makes in a row
constexpr std::size_t kOpenPacks = 16;  // packs that are tried before another is begun
constexpr std::int32_t kNoTetrahedron = -1;

/// Corners of the face opposite each corner, so that it makes a tetrahedron of positive volume with
/// a point on its other side.
constexpr std::array<std::array<int, 3>, 4> kBeyond{{{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};

struct Cluster {
  std::array<std::int32_t, kStarCorners> vertex{};
  std::array<std::int32_t, kStarParts> part{};  // number of the edge, face or tetrahedron
  std::uint64_t owned{};
};

std::array<ClusterPart, kStarParts> list_star_parts() {
  std::array<ClusterPart, kStarParts> parts{};
  std::size_t next = 0;
  int bit = 0;
  for (int a = 0; a < 4; ++a) {
    for (int b = a + 1; b < 4; ++b) {
      parts[next++] = {2, {a, b}, bit++};
    }
  }
  parts[next++] = {4, {0, 1, 2, 3}, -1};
  for (const auto& f : kBeyond) {
    parts[next++] = {3, {f[0], f[1], f[2]}, bit++};
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const int apex = 4 + static_cast<int>(i);
    const auto& f = kBeyond[i];
    for (const int corner : f) {
      parts[next++] = {2, {apex, corner}, bit++};
    }
    parts[next++] = {4, {apex, f[0], f[1], f[2]}, -1};
    for (std::size_t c = 0; c < 3; ++c) {
      parts[next++] = {3, {apex, f[(c + 1) % 3], f[(c + 2) % 3]}, bit++};
    }
  }
  return parts;
}

/// Finds clusters, each tetrahedron in one of them.
class ClusterSearch {
 public:
  explicit ClusterSearch(const SpringBody& body)
      : tetrahedra_(body.tetrahedra), index_(body.parts), taken_(tetrahedra_.size(), false) {
    neighbours_.assign(tetrahedra_.size(), {-1, -1, -1, -1});
    std::vector<std::pair<std::int32_t, int>> first(body.parts.faces.size(), {kNoTetrahedron, 0});
    for (std::size_t t = 0; t < tetrahedra_.size(); ++t) {
      for (std::size_t i = 0; i < 4; ++i) {
        auto& [other, side] = first[static_cast<std::size_t>(face_opposite(t, i))];
        if (other == kNoTetrahedron) {
          other = static_cast<std::int32_t>(t);
          side = static_cast<int>(i);
          continue;
        }
        neighbours_[t][i] = other;
        neighbours_[static_cast<std::size_t>(other)][static_cast<std::size_t>(side)] =
            static_cast<std::int32_t>(t);
      }
    }
  }

  std::vector<Cluster> stars() {
    std::vector<Cluster> found;
    const auto take = [&](std::size_t middle) {
      if (auto star = star_around(middle)) {
        found.push_back(*star);
      }
    };
    for (std::size_t t = 0; t + kPerVoxel <= tetrahedra_.size(); t += kPerVoxel) {
      for (std::size_t middle = t; middle < t + kPerVoxel; ++middle) {
        const auto& n = neighbours_[middle];
        const auto near = [&](std::int32_t other) {
          return other >= static_cast<std::int32_t>(t) &&
                 other < static_cast<std::int32_t>(t + kPerVoxel);
        };
        if (std::all_of(n.begin(), n.end(), near)) {
          take(middle);
        }
      }
    }
    for (std::size_t t = 0; t < tetrahedra_.size(); ++t) {
      take(t);
    }
    return found;
  }

  std::vector<Cluster> singles() {
    std::vector<Cluster> found;
    for (std::size_t t = 0; t < tetrahedra_.size(); ++t) {
      if (taken_[t]) {
        continue;
      }
      Cluster single;
      std::copy(tetrahedra_[t].begin(), tetrahedra_[t].end(), single.vertex.begin());
      number_parts(single, {static_cast<std::int32_t>(t)}, kSingleParts);
      found.push_back(single);
    }
    return found;
  }

 private:
  std::int32_t face_opposite(std::size_t t, std::size_t corner) const {
    const Tetrahedron& v = tetrahedra_[t];
    const auto& f = kBeyond[corner];
    return index_.face({v[static_cast<std::size_t>(f[0])], v[static_cast<std::size_t>(f[1])],
                        v[static_cast<std::size_t>(f[2])]});
  }

  std::optional<Cluster> star_around(std::size_t middle) {
    Cluster star;
    std::vector<std::int32_t> members{static_cast<std::int32_t>(middle)};
    std::copy(tetrahedra_[middle].begin(), tetrahedra_[middle].end(), star.vertex.begin());
    if (taken_[middle]) {
      return {};
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int32_t other = neighbours_[middle][i];
      if (other == kNoTetrahedron || taken_[static_cast<std::size_t>(other)]) {
        return {};
      }
      members.push_back(other);
      for (const std::int32_t v : tetrahedra_[static_cast<std::size_t>(other)]) {
        if (std::find(star.vertex.begin(), star.vertex.begin() + 4, v) == star.vertex.begin() + 4) {
          star.vertex[4 + i] = v;
        }
      }
    }
    const std::set<std::int32_t> distinct(star.vertex.begin(), star.vertex.end());
    if (distinct.size() < kStarCorners) {
      return {};
    }
    for (const std::int32_t t : members) {
      taken_[static_cast<std::size_t>(t)] = true;
    }
    number_parts(star, members, kStarParts);
    return star;
  }

  void number_parts(Cluster& cluster, const std::vector<std::int32_t>& members,
                    std::size_t parts) const {
    std::size_t tetrahedron = 0;
    for (std::size_t i = 0; i < parts; ++i) {
      const ClusterPart& part = star_parts()[i];
      const auto at = [&](std::size_t corner) {
        return cluster.vertex[static_cast<std::size_t>(part.corners[corner])];
      };
      cluster.part[i] = part.vertices == 2   ? index_.edge(at(0), at(1))
                        : part.vertices == 3 ? index_.face({at(0), at(1), at(2)})
                                             : members[tetrahedron++];
    }
  }

  const std::vector<Tetrahedron>& tetrahedra_;
  PartIndex index_;
  std::vector<std::array<std::int32_t, 4>> neighbours_;  // beyond the face opposite each corner
  std::vector<bool> taken_;
};

/// The last cluster with an edge or a face owns it.
class Owners {
 public:
  explicit Owners(const SpringBody& body)
      : edge_(body.parts.edges.size()), face_(body.parts.faces.size()) {}
  void see(const Cluster& cluster, std::size_t parts) {
    for_each(cluster, parts, [&](const Cluster*& owner, int) { owner = &cluster; });
  }
  void mark(Cluster& cluster, std::size_t parts) {
    for_each(cluster, parts, [&](const Cluster*& owner, int bit) {
      if (owner == &cluster) {
        cluster.owned |= std::uint64_t{1} << bit;
      }
    });
  }

 private:
  template <class Call>
  void for_each(const Cluster& cluster, std::size_t parts, const Call& call) {
    for (std::size_t i = 0; i < parts; ++i) {
      const ClusterPart& part = star_parts()[i];
      const auto number = static_cast<std::size_t>(cluster.part[i]);
      if (part.vertices == 2) {
        call(edge_[number], part.bit);
      }
      if (part.vertices == 3) {
        call(face_[number], part.bit);
      }
    }
  }
  std::vector<const Cluster*> edge_, face_;
};

/// Up to eight clusters without a common vertex.
using Lanes = std::vector<const Cluster*>;

bool shares_a_vertex(const Cluster& a, const Cluster& b, std::size_t corners) {
  return std::any_of(a.vertex.begin(), a.vertex.begin() + corners, [&](std::int32_t v) {
    return std::find(b.vertex.begin(), b.vertex.begin() + corners, v) != b.vertex.begin() + corners;
  });
}

/// Puts clusters into packs; those that stay unfilled come last in the answer's second list.
std::pair<std::vector<Lanes>, std::vector<Lanes>> fill(const Lanes& clusters, std::size_t corners) {
  std::vector<Lanes> full, open;
  for (const Cluster* cluster : clusters) {
    const auto fits = [&](const Lanes& lanes) {
      return std::none_of(lanes.begin(), lanes.end(), [&](const Cluster* other) {
        return shares_a_vertex(*cluster, *other, corners);
      });
    };
    auto pack = std::find_if(open.begin(), open.end(), fits);
    if (pack == open.end()) {
      pack = open.insert(open.end(), Lanes{});
    }
    pack->push_back(cluster);
    if (pack->size() == kPackLanes || open.size() > kOpenPacks) {
      const auto done = pack->size() == kPackLanes ? pack : open.begin();
      full.push_back(*done);
      open.erase(done);
    }
  }
  return {full, open};
}

/// Clusters that own alike go together; what is left of each kind is put together.
std::vector<Lanes> arrange(const std::vector<Cluster>& clusters, std::size_t corners) {
  std::map<std::uint64_t, Lanes> alike;
  for (const Cluster& cluster : clusters) {
    alike[cluster.owned].push_back(&cluster);
  }
  std::vector<Lanes> packs;
  Lanes left;
  for (const auto& [owned, group] : alike) {
    auto [full, open] = fill(group, corners);
    packs.insert(packs.end(), full.begin(), full.end());
    for (const Lanes& lanes : open) {
      left.insert(left.end(), lanes.begin(), lanes.end());
    }
  }
  for (const Lanes& lanes : fill(left, corners).first) {
    packs.push_back(lanes);
  }
  for (const Lanes& lanes : fill(left, corners).second) {
    packs.push_back(lanes);
  }
  // The order of the body's tetrahedra, so that neighbours are near in memory.
  std::sort(packs.begin(), packs.end(),
            [](const Lanes& a, const Lanes& b) { return a.front() < b.front(); });
  return packs;
}

struct Constants {
  double measure, pull;
};

/// Factors of the kernel. Edges: 1 / (2 L0²) and k / L0². Faces, whose measure is the square of the
/// doubled area: 1 / (8 A0²) and k / (8 A0²). Tetrahedra: 6 V0 and k / (6 V0)².
Constants constants_of(const SpringBody& body, const ClusterPart& part, std::int32_t number) {
  const auto i = static_cast<std::size_t>(number);
  if (part.vertices == 2) {
    const double square = body.lengths[i] * body.lengths[i];
    return {0.5 / square, body.constants.length[i] / square};
  }
  if (part.vertices == 3) {
    const double square = body.areas[i] * body.areas[i];
    return {1 / (8 * square), body.constants.area[i] / (8 * square)};
  }
  const double six = 6 * body.volumes[i];
  return {six, body.constants.volume[i] / (six * six)};
}

/// The constants of one part of up to eight clusters, if any of them owns it.
void add_row(const SpringBody& body, const Lanes& lanes, std::size_t i, std::uint64_t owned,
             ClusterPacks& packs) {
  const ClusterPart& part = star_parts()[i];
  const auto has = [&](std::uint64_t bits) { return part.bit < 0 || (bits >> part.bit & 1); };
  if (!has(owned)) {
    return;
  }
  std::array<Constants, kPackLanes> row;
  row.fill({part.bit < 0 ? 0.0 : 0.5, 0.0});
  for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
    if (has(lanes[lane]->owned)) {
      row[lane] = constants_of(body, part, lanes[lane]->part[i]);
    }
  }
  for (const Constants& c : row) {
    packs.constants.push_back(c.measure);
  }
  for (const Constants& c : row) {
    packs.constants.push_back(c.pull);
  }
}

ClusterPacks lay_out(const SpringBody& body, const std::vector<Cluster>& clusters,
                     std::size_t corners, std::size_t parts) {
  ClusterPacks packs;
  for (const Lanes& lanes : arrange(clusters, corners)) {
    std::uint64_t owned = 0;
    for (const Cluster* cluster : lanes) {
      owned |= cluster->owned;
    }
    packs.owned.push_back(owned);
    for (std::size_t corner = 0; corner < corners; ++corner) {
      for (std::size_t lane = 0; lane < kPackLanes; ++lane) {
        const auto filler = static_cast<std::int32_t>(body.rest.size() + corner);
        packs.corners.push_back(4 * (lane < lanes.size() ? lanes[lane]->vertex[corner] : filler));
      }
    }
    const auto add_rows = [&](bool tetrahedra) {
      for (std::size_t i = 0; i < parts; ++i) {
        if ((star_parts()[i].bit < 0) == tetrahedra) {
          add_row(body, lanes, i, owned, packs);
        }
      }
    };
    add_rows(true);
    add_rows(false);
  }
  return packs;
}

}  // namespace

const std::array<ClusterPart, kStarParts>& star_parts() {
  static const std::array<ClusterPart, kStarParts> parts = list_star_parts();
  return parts;
}

SpringPacks pack_springs(const SpringBody& body) {
  ClusterSearch search(body);
  std::vector<Cluster> stars = search.stars();
  std::vector<Cluster> singles = search.singles();
  Owners owners(body);
  for (const Cluster& cluster : stars) {
    owners.see(cluster, kStarParts);
  }
  for (const Cluster& cluster : singles) {
    owners.see(cluster, kSingleParts);
  }
  for (Cluster& cluster : stars) {
    owners.mark(cluster, kStarParts);
  }
  for (Cluster& cluster : singles) {
    owners.mark(cluster, kSingleParts);
  }
  SpringPacks packs{lay_out(body, stars, kStarCorners, kStarParts),
                    lay_out(body, singles, kSingleCorners, kSingleParts), 0};
  packs.tetrahedra = kPackLanes * (5 * packs.stars.owned.size() + packs.singles.owned.size());
  return packs;
}

}  // namespace haptrial::deformable
