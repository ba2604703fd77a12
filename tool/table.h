// The report for people: the figures of Table 1 of Yan & Wonka 2016, repairs and the certificate.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nonobtuse/certificate.h"
#include "nonobtuse/io.h"
#include "nonobtuse/quality.h"

namespace nonobtuse::tool {

/// One column of figures.
struct Column {
  std::string title;
  Index vertices = 0;
  AngleQuality angles;
  std::optional<SurfaceDistance> distance;
};

/// One row per figure, one column per mesh. Distances only if some column has them.
std::string quality_table(const std::vector<Column>& columns);

/// Topology, self-intersections and flips, as rows below the table of `measure`.
std::string topology_table(const QualityReport& report, bool with_reference);

/// One line per repair; empty if there was none.
std::string repairs_text(const std::string& path, const std::vector<Repair>& repairs);

/// The smallest and the largest angle of a triangle, degrees, to name it by.
struct TriangleAngles {
  double smallest = 0;
  double largest = 0;
};
TriangleAngles angles_of(const TriangleMesh& mesh, Index triangle);

/// The verdict, and where it is negative the `worst` worst triangles with angles and place.
std::string certificate_text(const std::string& path, const TriangleMesh& mesh,
                             const Certificate& certificate, Index worst);

}  // namespace nonobtuse::tool
