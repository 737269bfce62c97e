#pragma once

// CGAL's AABB tree and Embree's point query behind the same two calls, for bench_distance; Embree's
// ray beside a proxy's tick, for bench_contact.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/geometry/mesh/mesh.h"

#ifdef HAPTRIAL_CGAL
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#endif
#ifdef HAPTRIAL_EMBREE
#include <embree3/rtcore.h>
#endif

namespace haptrial::bench {

#ifdef HAPTRIAL_CGAL
class CgalTree {
  using Kernel = CGAL::Simple_cartesian<double>;
  using Point = Kernel::Point_3;
  using Triangles = std::vector<Kernel::Triangle_3>;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
  using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

 public:
  explicit CgalTree(const geometry::Mesh& mesh) {
    triangles_.reserve(mesh.triangles.size());
    for (const geometry::Triangle& t : mesh.triangles) {
      triangles_.emplace_back(point(mesh.vertices[t[0]]), point(mesh.vertices[t[1]]),
                              point(mesh.vertices[t[2]]));
    }
    tree_.insert(triangles_.cbegin(), triangles_.cend());
    tree_.build();
    tree_.accelerate_distance_queries();
  }
  CgalTree(const CgalTree&) = delete;
  CgalTree& operator=(const CgalTree&) = delete;

  void answer(const std::vector<Eigen::Vector3d>& points, bool warm,
              std::vector<double>& squared) const {
    Point before;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Point p = point(points[i]);
      const Point found = warm && i > 0 ? tree_.closest_point(p, before) : tree_.closest_point(p);
      squared[i] = CGAL::squared_distance(p, found);
      before = found;
    }
  }

 private:
  static Point point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

  Triangles triangles_;
  Tree tree_;
};
#endif

#ifdef HAPTRIAL_EMBREE
class EmbreeTree {
 public:
  explicit EmbreeTree(const geometry::Mesh& mesh)
      : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    vertices_ = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                            RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                            mesh.vertices.size()));
    indices_ = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), mesh.triangles.size()));
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        vertices_[3 * i + k] = static_cast<float>(mesh.vertices[i][k]);
      }
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        indices_[3 * i + k] = static_cast<unsigned>(mesh.triangles[i][k]);
      }
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeTree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeTree(const EmbreeTree&) = delete;
  EmbreeTree& operator=(const EmbreeTree&) = delete;

  void answer(const std::vector<Eigen::Vector3d>& points, bool warm,
              std::vector<double>& squared) const {
    Query query{this, Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};
    for (std::size_t i = 0; i < points.size(); ++i) {
      query.point = points[i].cast<float>();
      RTCPointQuery at{query.point.x(), query.point.y(), query.point.z(), 0.0f,
                       std::numeric_limits<float>::infinity()};
      // A little more than the distance to the answer before, which is still on the surface.
      if (warm && i > 0) {
        at.radius = 1.00001f * (query.point - query.nearest).norm() + 1e-12f;
      }
      RTCPointQueryContext context;
      rtcInitPointQueryContext(&context);
      rtcPointQuery(scene_, &at, &context, visit, &query);
      squared[i] = static_cast<double>((query.point - query.nearest).squaredNorm());
    }
  }

  /// The share of the way from one point to another up to the first triangle; 1 where there is none.
  double meets(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    const Eigen::Vector3f origin = from.cast<float>(), way = (to - from).cast<float>();
    RTCRayHit ray{};
    ray.ray.org_x = origin.x();
    ray.ray.org_y = origin.y();
    ray.ray.org_z = origin.z();
    ray.ray.dir_x = way.x();
    ray.ray.dir_y = way.y();
    ray.ray.dir_z = way.z();
    ray.ray.tfar = 1.0f;
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_, &context, &ray);
    return static_cast<double>(ray.ray.tfar);
  }

 private:
  struct Query {
    const EmbreeTree* tree;
    Eigen::Vector3f point, nearest;
  };

  static bool visit(RTCPointQueryFunctionArguments* arguments) {
    auto& query = *static_cast<Query*>(arguments->userPtr);
    const unsigned* t = query.tree->indices_ + 3 * arguments->primID;
    const auto corner = [&](int k) {
      return Eigen::Map<const Eigen::Vector3f>(query.tree->vertices_ + 3 * t[k]);
    };
    const Eigen::Vector3f near = nearest(query.point, corner(0), corner(1), corner(2));
    const float distance = (near - query.point).norm();
    if (!(distance < arguments->query->radius)) {
      return false;
    }
    arguments->query->radius = distance;
    query.nearest = near;
    return true;
  }

  /// The nearest point of a triangle, by the regions of its plane.
  static Eigen::Vector3f nearest(const Eigen::Vector3f& p, const Eigen::Vector3f& a,
                                 const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
    const Eigen::Vector3f ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const float ab_ap = ab.dot(ap), ac_ap = ac.dot(ap);
    if (ab_ap <= 0.0f && ac_ap <= 0.0f) {
      return a;
    }
    const float ab_bp = ab.dot(bp), ac_bp = ac.dot(bp);
    if (ab_bp >= 0.0f && ac_bp <= ab_bp) {
      return b;
    }
    const float ab_cp = ab.dot(cp), ac_cp = ac.dot(cp);
    if (ac_cp >= 0.0f && ab_cp <= ac_cp) {
      return c;
    }
    const float of_c = ab_ap * ac_bp - ab_bp * ac_ap;
    if (of_c <= 0.0f && ab_ap >= 0.0f && ab_bp <= 0.0f) {
      return a + ab_ap / (ab_ap - ab_bp) * ab;
    }
    const float of_b = ab_cp * ac_ap - ab_ap * ac_cp;
    if (of_b <= 0.0f && ac_ap >= 0.0f && ac_cp <= 0.0f) {
      return a + ac_ap / (ac_ap - ac_cp) * ac;
    }
    const float of_a = ab_bp * ac_cp - ab_cp * ac_bp;
    const float along = ac_bp - ab_bp, back = ab_cp - ac_cp;
    if (of_a <= 0.0f && along >= 0.0f && back >= 0.0f) {
      return b + along / (along + back) * (c - b);
    }
    const float scale = 1.0f / (of_a + of_b + of_c);
    return a + of_b * scale * ab + of_c * scale * ac;
  }

  RTCDevice device_;
  RTCScene scene_;
  float* vertices_;
  unsigned* indices_;
};
#endif

}  // namespace haptrial::bench
