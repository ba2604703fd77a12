// numpy arrays to meshes and back. The Python side (nonobtuse/_arrays.py) has checked shapes and
// dtypes and made the arrays contiguous; they are read, never written.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "nonobtuse/mesh.h"

namespace nonobtuse::python {

namespace nb = nanobind;

/// #V by 3 coordinates.
using VertexArray = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
/// #V numbers.
using LengthArray = nb::ndarray<const double, nb::shape<-1>, nb::c_contig, nb::device::cpu>;
/// #F by 3 vertex indices.
using FaceArray = nb::ndarray<const std::int32_t, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

/// #E by 2 vertex indices.
using EdgeArray = nb::ndarray<const std::int32_t, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Triangle) == 3 * sizeof(Index));

/// The rows of an array as a vector of `Row`.
template <class Row, class Array>
std::vector<Row> rows_of(const Array& array) {
  std::vector<Row> rows(array.shape(0));
  if (!rows.empty())
    std::memcpy(static_cast<void*>(rows.data()), array.data(), rows.size() * sizeof(Row));
  return rows;
}

inline TriangleMesh mesh_of(const VertexArray& vertices, const FaceArray& faces) {
  return {rows_of<Vec3>(vertices), rows_of<Triangle>(faces)};
}

/// A numpy array that owns what was in `items`, without a copy; `columns` = 0 makes it flat.
template <class Scalar, class Item>
nb::object array_of(std::vector<Item>&& items, std::size_t columns) {
  static_assert(sizeof(Item) % sizeof(Scalar) == 0);
  auto held = std::make_unique<std::vector<Item>>(std::move(items));
  if (held->empty()) held->reserve(1);  // numpy wants an address even where there is nothing
  const std::size_t rows = held->size();
  auto* data = reinterpret_cast<Scalar*>(held->data());
  nb::capsule owner(held.release(),
                    [](void* p) noexcept { delete static_cast<std::vector<Item>*>(p); });
  const std::size_t shape[2] = {rows, columns};
  return nb::cast(nb::ndarray<nb::numpy, Scalar>(data, columns == 0 ? 1 : 2, shape, owner));
}

inline nb::object array_of(std::vector<Vec3>&& points) {
  return array_of<double>(std::move(points), 3);
}
inline nb::object array_of(std::vector<Triangle>&& triangles) {
  return array_of<Index>(std::move(triangles), 3);
}
inline nb::object array_of(std::vector<std::array<Index, 2>>&& edges) {
  return array_of<Index>(std::move(edges), 2);
}
inline nb::object array_of(std::vector<Index>&& indices) {
  return array_of<Index>(std::move(indices), 0);
}
inline nb::object array_of(std::vector<double>&& values) {
  return array_of<double>(std::move(values), 0);
}

}  // namespace nonobtuse::python
