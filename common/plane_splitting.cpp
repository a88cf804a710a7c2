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
  RunForest(const CellConnectivity& connectivity, const PoolVector<int>& labels)
      : connectivity_(connectivity), labels_(labels.data()), columns_(connectivity.columns()), run_of_(labels.size()) {
    const int cells = static_cast<int>(labels.size());
    for (int first = 0; first < cells; first += columns_) {
      visit_cells(
          first, first + columns_, [&](int block) { return add_block(block); }, [&](int cell) { add(cell); });
    }
  }

  // Numbers the pieces in the order of their first cells. Returns their sizes.
  PoolVector<int> number_pieces() {
    PoolVector<int> cells;
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
  [[nodiscard]] const PoolVector<Run>& runs() const { return runs_; }

 private:
  // Adds the cells of a block where there are none to add, or where they go on with the last run and lie below one run.
  bool add_block(int first) {
    const int* own = labels_ + first;
    if (!all_are(*own, own)) return false;
    if (*own == 0) return true;
    if (!goes_on(first) || first < columns_ || !connectivity_.all_linked_back(first)) return false;
    const int above = first - columns_;
    if (!all_are(*own, labels_ + above) || run_of(above) != run_of(above + kBlock - 1)) return false;
    std::fill_n(&run_of(first), kBlock, static_cast<int>(runs_.size()) - 1);
    runs_.back().end += kBlock;
    join(run_of(above));
    return true;
  }

  void add(int cell) {
    const int label = labels_[cell];
    if (label == 0) return;
    if (!goes_on(cell) || connectivity_.left(cell) != cell - 1) {
      const int own = static_cast<int>(runs_.size());
      runs_.push_back({cell, cell, label, own});
      joined_ = own;
      // The cell before is of another run, but one without data may lie between two of one piece.
      if (const int left = connectivity_.left(cell); left >= 0 && labels_[left] == label) join(run_of(left));
    }
    run_of(cell) = static_cast<int>(runs_.size()) - 1;
    ++runs_.back().end;
    if (const int up = connectivity_.up(cell); up >= 0 && labels_[up] == label) join(run_of(up));
  }

  // Whether a cell follows the last run and has its label.
  [[nodiscard]] bool goes_on(int cell) const {
    return !runs_.empty() && runs_.back().end == cell && runs_.back().label == labels_[cell];
  }
  [[nodiscard]] int& run_of(int cell) { return run_of_[static_cast<std::size_t>(cell)]; }
  [[nodiscard]] int& parent(int run) { return runs_[static_cast<std::size_t>(run)].piece; }
  int root_of(int run) {
    while (parent(run) != run) run = parent(run) = parent(parent(run));
    return run;
  }
  // The last run is of one piece with one before.
  void join(int before) {
    if (before == joined_) return;
    joined_ = before;
    const int a = root_of(before);
    const int b = root_of(static_cast<int>(runs_.size()) - 1);
    parent(std::max(a, b)) = std::min(a, b);
  }

  const CellConnectivity& connectivity_;
  const int* labels_;
  int columns_;
  PoolVector<int> run_of_;  // by cell; set where the cell is of a plane
  PoolVector<Run> runs_;
  int joined_ = -1;  // the run that the last one was joined with last, or itself
};

// By piece. The first piece of a plane, mostly all of it, has the sums of the plane less those of the other pieces.
PoolVector<PointSums> sums_of_pieces(const RangeImage& image, const PoolVector<Run>& runs, std::size_t pieces,
                                     const PoolVector<PointSums>& sums_of_planes) {
  PoolVector<PointSums> sums(pieces);
  PoolVector<int> first_piece(sums_of_planes.size(), -1);
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
  const PoolVector<int> cells = forest.number_pieces();
  const PoolVector<PointSums> sums = sums_of_pieces(image, forest.runs(), cells.size(), found.sums);
  found.planes.clear();
  found.sums.clear();
  PoolVector<int> label_of(sums.size(), 0);
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
