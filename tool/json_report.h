// The report for programs. The schema is documented in docs/json.md.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "nonobtuse/certificate.h"
#include "nonobtuse/io.h"
#include "nonobtuse/options.h"
#include "nonobtuse/quality.h"
#include "nonobtuse/result.h"

namespace nonobtuse::tool {

using Json = nlohmann::ordered_json;

Json to_json(const AngleQuality& angles);
Json to_json(const Topology& topology);
Json to_json(const SurfaceDistance& distance);
Json to_json(const QualityReport& report, bool with_reference);
/// Names at most `worst` triangles of each list; the counts are complete.
Json to_json(const Certificate& certificate, const TriangleMesh& mesh, Index worst);
Json to_json(const std::vector<Repair>& repairs);
Json to_json(const std::vector<StageTime>& stages);
Json to_json(const std::vector<IterationRecord>& history);
Json to_json(const SizeRatio& ratio);
Json to_json(const std::vector<NarrowCorner>& corners);
Json to_json(const RemeshOptions& options);

/// `text` that is not UTF-8 (a file name may be anything) is mended instead of refused.
std::string dump(const Json& json);

}  // namespace nonobtuse::tool
