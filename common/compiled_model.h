// What the compiler knows about one object and the runtime uses: the content of a database, as plain structs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/density.h"
#include "common/golden_scan.h"
#include "common/pose.h"
#include "common/region_attributes.h"
#include "common/relation_attributes.h"
#include "common/segmentation.h"
#include "common/sensor_model.h"

namespace foresight {

inline constexpr int kAspectCells = 80;  // Section V.A

// One planar face of the CAD model, in the model frame.
struct ModelFace {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    // unit, outward
  double offset = 0.0;                                 // normal . p = offset. Unit: mm.
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  // of the whole face. Unit: mm.
  double area = 0.0;                                   // Unit: mm^2.
  int views_found = 0;  // sample views in which extraction found it: P(M) before normalisation
  std::array<Density, kAttributeCount> densities;  // P(f^k|M), empty when views_found == 0
};

// P(f|M_l, M_m) of two faces seen together; first < second.
struct FacePair {
  int first = 0;
  int second = 0;
  int views_found = 0;
  std::array<Density, kRelationCount> densities;
};

struct TemplatePoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  // model frame. Unit: mm.
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    // of the first face in the list
  std::vector<int> faces;       // faces the point belongs to, ascending; an edge point has two or more
  std::vector<int> neighbours;  // N_i of Section V.C, ascending
};

// The 3DTM model of Section V.A.
struct SurfaceTemplate {
  double spacing = 5.0;  // no two points are nearer than this. Unit: mm.
  std::vector<TemplatePoint> points;
  std::array<std::vector<int>, kAspectCells> aspects;  // faces visible from each cell of ViewingSphere(80), ascending
};

// What two-way verification counts: the inputs of an AcceptanceModel, each from 0 to 1 (runtime/pose_evidence.h).
enum EvidenceFeature : int {
  kOwnedShare = 0,     // explained cells, weighted by the share of their regions, of those with data on or behind
  kContradictedShare,  // cells with data behind the surface or of another orientation, of those not hidden
  kMissing,            // towards 1 with the share of cells without data and without a reason, of those not hidden
  kHiddenShare,        // cells with data before the surface, beyond the image, or without data in what may be a shadow
  kFoundFaces,         // faces at least half explained, of those with data and one more: how many, and whether all
  kAmount,             // how much there is to go by: towards 1 with the number of owned cells
  kOtherSurfaces,      // explained cells that are not of the surface with most of them
  kHiddenBehindOne,    // hidden share times the share of that surface: one surface, and the rest cannot be checked
};
inline constexpr int kEvidenceFeatureCount = 8;

// How probable it is that a pose with this evidence is right: a logistic model that the compiler fits to simulated
// right and wrong poses of the object.
struct AcceptanceModel {
  std::array<double, kEvidenceFeatureCount> weights{};
  double bias = 0.0;
  // Of start poses, before localization: below these none came to a right pose. Limit: 0 to 1.
  double least_quality = 0.0;      // PoseCheck::quality
  double least_probability = 0.0;  // by this model, of the evidence there
  int samples = 0;                 // simulated poses it was fitted to; 0: none, a database without acceptance models
};

inline constexpr int kMostExactSymmetries = 512;  // of one model: enough for a cylinder of 256 facets
inline constexpr int kMostNearSymmetries = 32;    // of one model

// A motion of the object under which it looks the same, or almost the same, to the sensor it was compiled for.
struct Symmetry {
  Pose T_model_model;
  bool exact =
      false;  // the planar faces and corners come to lie on themselves; the exact ones and the identity are a group
  double overlap = 0.0;  // share of the surface that comes to lie on the surface. Limit: 0 to 1.
};

// One object, ready for recognition.
struct CompiledModel {
  std::string name;
  std::string cad_file;    // name of the CAD file without its folder
  std::string cad_sha256;  // hex digest of its bytes
  std::string cad_unit = "mm";
  double diameter = 0.0;                             // largest distance between two vertices. Unit: mm.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // of the bounding box, model frame. Unit: mm.
  int views = 0;                                     // number of sample views
  std::vector<ModelFace> faces;
  std::vector<FacePair> pairs;  // ascending by (first, second)
  SurfaceTemplate surface;
  AcceptanceModel acceptance;
  std::vector<Symmetry> symmetries;           // without the identity; exact ones first
  std::vector<Eigen::Vector3f> vertices;      // of the CAD mesh, for overlays and for pose distances. Unit: mm.
  std::vector<std::array<int, 3>> triangles;  // indices into vertices
  std::vector<int> triangle_faces;            // face of each triangle; empty in databases of earlier compilers
  std::optional<GoldenScan> golden_scan;      // none where the compiler recognized none; none from earlier compilers
};

// A database is compiled models that share a sensor and extraction settings.
struct CompiledDatabase {
  std::string tool_version;
  std::string ray_isa;  // instruction set the rays were cast with
  SensorModel sensor;
  SegmentationOptions segmentation;
  DensityOptions density;
  std::vector<CompiledModel> models;
};

}  // namespace foresight
