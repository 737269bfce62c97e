#pragma once

#include "core/deformable/springs/force_kernel.h"
#include "core/deformable/springs/force_kernel_vectors.h"

// Included once for each instruction set, by a file that says how many numbers go side by side
// (kLanes), and gives Lanes, Flags, fused(), gather() and scatter(): everything is its own.
namespace haptrial::deformable {
namespace {

constexpr std::size_t kPack = 8;

constexpr int kMostTensions = 34;

/// The kernel's data of eight clusters (or of as many as there are lanes). The middle's edges are
/// 01, 02, 03, 12, 13 and 23; a neighbour's spokes go from its apex to the corners of the middle's
/// face. Both are subtracted anew where they pull, as that costs less than to keep them.
struct Cluster {
  Vectors point[4], force[4], apex[4];
  Vectors back[4];  // the volume's force on the apex
  Lanes square[6], spoke_square[4][3];
  // Squared, of the owned edges and faces, then their tensions; one more place takes what is not
  // kept.
  Lanes measure[kMostTensions + 1];
};

/// Collects measures, then hands out what became of them, in the order of star_parts().
struct Queue {
  Lanes* next;
  std::uint64_t owned;

  HAPTRIAL_LANES bool owns(int bit) const { return (owned >> bit & 1) != 0; }
  /// Puts a measure without a branch, so that the compiler mixes independent parts.
  HAPTRIAL_LANES void put(int bit, const Lanes& measure) {
    *next = measure;
    next += owned >> bit & 1;
  }
  HAPTRIAL_LANES Lanes take(int bit) { return owns(bit) ? *next++ : Lanes{}; }
};

/// pull · (6 V0 - 6 V), and counts what is upright.
HAPTRIAL_LANES Lanes pressure(const double*& constants, const Lanes& six_volumes, Flags& upright) {
  upright += six_volumes > Lanes{};
  const Lanes value = load(constants + kPack) * (load(constants) - six_volumes);
  constants += 2 * kPack;
  return value;
}

/// pull · (1 - rest / measure) of the next n springs, from half of their squares.
template <int n>
HAPTRIAL_LANES void some_tensions(const double*& constants, Lanes*& spring) {
  const Group<n> half = HAPTRIAL_EACH(spring[i] * load(constants + 2 * kPack * i));
  const Group<n> pull = HAPTRIAL_EACH(load(constants + 2 * kPack * i + kPack));
  const Group<n> tension = fused(-pull, inverse_root_of_twice(half), pull);
  for (int i = 0; i < n; ++i) {
    spring[i] = tension.part[i];
  }
  constants += 2 * kPack * n;
  spring += n;
}

HAPTRIAL_LANES const double* to_tensions(const double* constants, Lanes* spring, const Lanes* end) {
  constexpr int kTogether = 4;
  while (end - spring >= kTogether) {
    some_tensions<kTogether>(constants, spring);
  }
  while (spring != end) {
    some_tensions<1>(constants, spring);
  }
  return constants;
}

HAPTRIAL_LANES void measure_middle(Cluster& m, const double* positions, const std::int32_t* corners,
                                   const double*& constants, Flags& upright, Queue& queue) {
  for (int i = 0; i < 4; ++i) {
    gather(positions, corners + kPack * i, m.point[i].x, m.point[i].y, m.point[i].z);
  }
  const Vectors edge[6] = {m.point[1] - m.point[0], m.point[2] - m.point[0],
                           m.point[3] - m.point[0], m.point[2] - m.point[1],
                           m.point[3] - m.point[1], m.point[3] - m.point[2]};
#pragma GCC unroll 6
  for (int i = 0; i < 6; ++i) {
    m.square[i] = dot(edge[i], edge[i]);
    queue.put(i, m.square[i]);
  }
  const Vectors n1 = cross(edge[1], edge[2]);
  const Vectors n2 = cross(edge[2], edge[0]);
  const Vectors n3 = cross(edge[0], edge[1]);
  const Vectors n0 = n1 + n2 + n3;
  const Lanes p = pressure(constants, dot(edge[0], n1), upright);
  m.force[0] = -p * n0;
  m.force[1] = p * n1;
  m.force[2] = p * n2;
  m.force[3] = p * n3;
  queue.put(6, dot(n0, n0));
  queue.put(7, dot(n1, n1));
  queue.put(8, dot(n2, n2));
  queue.put(9, dot(n3, n3));
}

/// The neighbour i beyond the face of corners j, k and l.
template <int i, int j, int k, int l>
HAPTRIAL_LANES void measure_neighbour(Cluster& m, const double* positions,
                                      const std::int32_t* corners, const double*& constants,
                                      Flags& upright, Queue& queue) {
  constexpr int bit = 10 + 6 * i;
  Vectors apex;
  gather(positions, corners + kPack * (4 + i), apex.x, apex.y, apex.z);
  const Vectors spoke[3] = {m.point[j] - apex, m.point[k] - apex, m.point[l] - apex};
  m.apex[i] = apex;
#pragma GCC unroll 3
  for (int c = 0; c < 3; ++c) {
    m.spoke_square[i][c] = dot(spoke[c], spoke[c]);
    queue.put(bit + c, m.spoke_square[i][c]);
  }
  const Vectors nj = cross(spoke[1], spoke[2]);
  const Vectors nk = cross(spoke[2], spoke[0]);
  const Vectors nl = cross(spoke[0], spoke[1]);
  const Lanes p = pressure(constants, dot(spoke[0], nj), upright);
  m.force[j] = fused(p, nj, m.force[j]);
  m.force[k] = fused(p, nk, m.force[k]);
  m.force[l] = fused(p, nl, m.force[l]);
  m.back[i] = -p * (nj + nk + nl);
  queue.put(bit + 3, dot(nj, nj));
  queue.put(bit + 4, dot(nk, nk));
  queue.put(bit + 5, dot(nl, nl));
}

/// A face pulls along its edges: the gradient of its area is that of a function of their lengths.
/// @param a, b, c  squared lengths; ta, tb, tc  the edges' tensions
HAPTRIAL_LANES void add_face(const Lanes& g, const Lanes& a, const Lanes& b, const Lanes& c,
                             Lanes& ta, Lanes& tb, Lanes& tc) {
  ta = fused(g, b + c - a, ta);
  tb = fused(g, a + c - b, tb);
  tc = fused(g, a + b - c, tc);
}

/// Neighbour i, whose face's edges jk, kl and lj are those of the middle.
template <int i, int j, int k, int l, int jk, int kl, int lj>
HAPTRIAL_LANES void pull_neighbour(Cluster& m, double* forces, const std::int32_t* corners,
                                   Queue& queue, Lanes* t) {
  constexpr int bit = 10 + 6 * i;
  Lanes tj = queue.take(bit);
  Lanes tk = queue.take(bit + 1);
  Lanes tl = queue.take(bit + 2);
  const Lanes* s = m.square;
  const Lanes& sj = m.spoke_square[i][0];
  const Lanes& sk = m.spoke_square[i][1];
  const Lanes& sl = m.spoke_square[i][2];
  if (queue.owns(bit + 3)) {
    add_face(*queue.next++, sk, sl, s[kl], tk, tl, t[kl]);
  }
  if (queue.owns(bit + 4)) {
    add_face(*queue.next++, sl, sj, s[lj], tl, tj, t[lj]);
  }
  if (queue.owns(bit + 5)) {
    add_face(*queue.next++, sj, sk, s[jk], tj, tk, t[jk]);
  }
  const Vectors ej = m.point[j] - m.apex[i];
  const Vectors ek = m.point[k] - m.apex[i];
  const Vectors el = m.point[l] - m.apex[i];
  m.force[j] = fused(-tj, ej, m.force[j]);
  m.force[k] = fused(-tk, ek, m.force[k]);
  m.force[l] = fused(-tl, el, m.force[l]);
  const Vectors pulled = fused(tj, ej, fused(tk, ek, fused(tl, el, m.back[i])));
  scatter(forces, corners + kPack * (4 + i), pulled.x, pulled.y, pulled.z);
}

HAPTRIAL_LANES void pull(const Lanes& tension, const Vectors& edge, Vectors& from, Vectors& to) {
  from = fused(tension, edge, from);
  to = fused(-tension, edge, to);
}

HAPTRIAL_LANES void pull_middle(Cluster& m, double* forces, const std::int32_t* corners,
                                const Lanes* tension) {
  pull(tension[0], m.point[1] - m.point[0], m.force[0], m.force[1]);
  pull(tension[1], m.point[2] - m.point[0], m.force[0], m.force[2]);
  pull(tension[2], m.point[3] - m.point[0], m.force[0], m.force[3]);
  pull(tension[3], m.point[2] - m.point[1], m.force[1], m.force[2]);
  pull(tension[4], m.point[3] - m.point[1], m.force[1], m.force[3]);
  pull(tension[5], m.point[3] - m.point[2], m.force[2], m.force[3]);
  for (int i = 0; i < 4; ++i) {
    scatter(forces, corners + kPack * i, m.force[i].x, m.force[i].y, m.force[i].z);
  }
}

HAPTRIAL_LANES void take_middle(const Cluster& m, Queue& queue, Lanes* t) {
#pragma GCC unroll 6
  for (int i = 0; i < 6; ++i) {
    t[i] = queue.take(i);
  }
  const Lanes* s = m.square;
  if (queue.owns(6)) {
    add_face(*queue.next++, s[3], s[4], s[5], t[3], t[4], t[5]);
  }
  if (queue.owns(7)) {
    add_face(*queue.next++, s[1], s[2], s[5], t[1], t[2], t[5]);
  }
  if (queue.owns(8)) {
    add_face(*queue.next++, s[0], s[2], s[4], t[0], t[2], t[4]);
  }
  if (queue.owns(9)) {
    add_face(*queue.next++, s[0], s[1], s[3], t[0], t[1], t[3]);
  }
}

/// Measures everything, then turns measures into tensions, then pulls: within each of the three
/// nothing waits for anything else.
template <bool star>
HAPTRIAL_LANES void add_pack(const ForceQuery& query, const std::int32_t* corners,
                             std::uint64_t owned, const double*& constants, Flags& upright) {
  Cluster m;
  const double* x = query.positions;
  Queue queue{m.measure, owned};
  measure_middle(m, x, corners, constants, upright, queue);
  if constexpr (star) {
    measure_neighbour<0, 1, 3, 2>(m, x, corners, constants, upright, queue);
    measure_neighbour<1, 0, 2, 3>(m, x, corners, constants, upright, queue);
    measure_neighbour<2, 0, 3, 1>(m, x, corners, constants, upright, queue);
    measure_neighbour<3, 0, 1, 2>(m, x, corners, constants, upright, queue);
  }
  constants = to_tensions(constants, m.measure, queue.next);
  queue.next = m.measure;
  Lanes tension[6];
  take_middle(m, queue, tension);
  if constexpr (star) {
    pull_neighbour<0, 1, 3, 2, 4, 5, 3>(m, query.forces, corners, queue, tension);
    pull_neighbour<1, 0, 2, 3, 1, 5, 2>(m, query.forces, corners, queue, tension);
    pull_neighbour<2, 0, 3, 1, 2, 4, 0>(m, query.forces, corners, queue, tension);
    pull_neighbour<3, 0, 1, 2, 0, 3, 1>(m, query.forces, corners, queue, tension);
  }
  pull_middle(m, query.forces, corners, tension);
}

/// @tparam known  what the pack owns, so that there are no branches; 0: `owned` says it
template <bool star, std::uint64_t known = 0>
__attribute__((noinline)) void add_alike(const ForceQuery& query, const std::int32_t* corners,
                                         std::uint64_t owned, const double*& constants,
                                         Flags& upright) {
  add_pack<star>(query, corners, known != 0 ? known : owned, constants, upright);
}

template <bool star>
HAPTRIAL_LANES void add_by_kind(const ForceQuery& query, const std::int32_t* corners,
                                std::uint64_t owned, const double*& constants, Flags& upright) {
  if constexpr (star) {
    if (owned == kInLattice[0]) {
      return add_alike<star, kInLattice[0]>(query, corners, owned, constants, upright);
    }
    if (owned == kInLattice[1]) {
      return add_alike<star, kInLattice[1]>(query, corners, owned, constants, upright);
    }
  }
  add_alike<star>(query, corners, owned, constants, upright);
}

template <bool star>
void add_packs(const ForceQuery& query, const PackView& view, Flags& upright) {
  constexpr std::size_t corners = star ? 8 : 4;
  const double* constants = view.constants;
  for (std::size_t pack = 0; pack < view.packs; ++pack) {
    const double* end = constants;
    for (std::size_t first = 0; first < kPack; first += kLanes) {
      const double* reader = constants + first;
      add_by_kind<star>(query, view.corners + pack * corners * kPack + first, view.owned[pack],
                        reader, upright);
      end = reader - first;
    }
    constants = end;
  }
}

std::size_t add_forces(const ForceQuery& query) noexcept {
  Flags upright{};  // minus how many
  add_packs<true>(query, query.stars, upright);
  add_packs<false>(query, query.singles, upright);
  long long count = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    count -= upright[lane];
  }
  return static_cast<std::size_t>(count);
}

}  // namespace
}  // namespace haptrial::deformable
