#include "common/plane_splitting.h"

#include <algorithm>
#include <memory>

namespace foresight {
namespace {

// Cells of one plane that follow one another in a row of the image, each connected with the one before.
struct Run {
  int first, end;  // cells
  int label;
  int piece;  // that it belongs to
};

// The runs of all planes, connected into pieces: a union-find forest whose roots are the first runs of the pieces.
class RunForest {
 public:
  RunForest(const CellConnectivity& connectivity, const std::vector<int>& labels)
      : connectivity_(connectivity),
        labels_(labels),
        run_of_(std::make_unique_for_overwrite<int[]>(labels.size())),
        end_of_image_(static_cast<int>(labels.size())) {
    for (int cell = 0; cell < end_of_image_;) cell = label(cell) == 0 ? cell + 1 : add_run(cell);
  }

  // Numbers the pieces in the order of their first cells. Returns their sizes.
  std::vector<int> number_pieces() {
    std::vector<int> cells;
    for (std::size_t i = 0; i < runs_.size(); ++i) {  // a parent always comes before its children
      Run& run = runs_[i];
      if (run.piece == static_cast<int>(i)) {
        run.piece = static_cast<int>(cells.size());
        cells.push_back(0);
      } else {
        run.piece = runs_[static_cast<std::size_t>(run.piece)].piece;
      }
      cells[static_cast<std::size_t>(run.piece)] += run.end - run.first;
    }
    return cells;
  }
  [[nodiscard]] const std::vector<Run>& runs() const { return runs_; }

 private:
  [[nodiscard]] int label(int cell) const { return labels_[static_cast<std::size_t>(cell)]; }

  // Returns the cell after it.
  int add_run(int first) {
    const int own = static_cast<int>(runs_.size());
    const int own_label = label(first);
    runs_.push_back({first, first, own_label, own});
    // The cell before is of another run, but one without data may lie between two of one piece.
    if (const int left = connectivity_.left(first); left >= 0 && label(left) == own_label) join(run_of(left), own);
    int joined = -1;
    int cell = first;
    do {
      run_of(cell) = own;
      const int up = connectivity_.up(cell);
      if (up >= 0 && label(up) == own_label && run_of(up) != joined) join(joined = run_of(up), own);
      ++cell;
    } while (cell < end_of_image_ && label(cell) == own_label && connectivity_.left(cell) == cell - 1);
    runs_.back().end = cell;
    return cell;
  }

  [[nodiscard]] int& run_of(int cell) { return run_of_[static_cast<std::size_t>(cell)]; }
  [[nodiscard]] int& parent(int run) { return runs_[static_cast<std::size_t>(run)].piece; }
  int root_of(int run) {
    while (parent(run) != run) run = parent(run) = parent(parent(run));
    return run;
  }
  void join(int before, int own) {
    const int a = root_of(before);
    const int b = root_of(own);
    parent(std::max(a, b)) = std::min(a, b);
  }

  const CellConnectivity& connectivity_;
  const std::vector<int>& labels_;
  std::unique_ptr<int[]> run_of_;  // by cell; set where the cell is of a plane
  int end_of_image_;
  std::vector<Run> runs_;
};

// By piece. The first piece of a plane, mostly all of it, has the sums of the plane less those of the other pieces.
std::vector<PointSums> sums_of_pieces(const RangeImage& image, const std::vector<Run>& runs, std::size_t pieces,
                                      const std::vector<PointSums>& sums_of_planes) {
  std::vector<PointSums> sums(pieces);
  std::vector<int> first_piece(sums_of_planes.size(), -1);
  for (const Run& run : runs) {
    const auto plane = static_cast<std::size_t>(run.label - 1);
    PointSums& own = sums[static_cast<std::size_t>(run.piece)];
    if (first_piece[plane] < 0) {
      first_piece[plane] = run.piece;
      own = sums_of_planes[plane];
    }
    if (first_piece[plane] == run.piece) continue;
    for (int cell = run.first; cell < run.end; ++cell) {
      const Eigen::Vector3d point = image[cell].cast<double>();
      sums[static_cast<std::size_t>(first_piece[plane])].remove(point);
      own.add(point);
    }
  }
  return sums;
}

}  // namespace

void split_planes(const RangeImage& image, const CellConnectivity& connectivity, const SegmentationOptions& options,
                  PlaneLabels& found) {
  RunForest forest(connectivity, found.labels);
  const std::vector<int> cells = forest.number_pieces();
  const std::vector<PointSums> sums = sums_of_pieces(image, forest.runs(), cells.size(), found.sums);
  found.planes.clear();
  found.sums.clear();
  std::vector<int> label_of(sums.size(), 0);
  for (std::size_t piece = 0; piece < sums.size(); ++piece) {
    if (cells[piece] < options.smallest_region) continue;
    const Plane plane = sums[piece].fit();
    if (!is_steady(sums[piece], plane, options)) continue;
    found.sums.push_back(sums[piece]);
    found.planes.push_back(plane);
    label_of[piece] = static_cast<int>(found.planes.size());
  }
  for (const Run& run : forest.runs()) {
    const int label = label_of[static_cast<std::size_t>(run.piece)];
    if (label != run.label) std::fill_n(found.labels.begin() + run.first, run.end - run.first, label);
  }
}

}  // namespace foresight
