#include "waymark/markers/cell_reading.hpp"

#include <algorithm>
#include <array>

#include <Eigen/LU>

#include "waymark/markers/homography.hpp"

namespace waymark::markers {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kCellContrastMin_grey = 10.0;
constexpr double kSharpening = 0.25;
constexpr double kFromMiddle_cells = 0.25;
constexpr int kSideMax = 11;  // 7 bits, border and paper

struct Cell {
  double grey = 0.0;  ///< mean of
  double darkest = 0.0;
  double brightest = 0.0;
};

/// All cells of a marker, and those of the paper around its border.
struct Cells {
  int side = 0;
  std::array<Cell, kSideMax * kSideMax> cells{};

  [[nodiscard]] Cell& operator()(int column, int row) { return cells[place(column, row)]; }
  [[nodiscard]] const Cell& operator()(int column, int row) const { return cells[place(column, row)]; }
  /// 0 for the paper around, 1 for the border.
  [[nodiscard]] int depth(int column, int row) const {
    return std::min(std::min(column, row), std::min(side - 1 - column, side - 1 - row));
  }

 private:
  [[nodiscard]] static std::size_t place(int column, int row) {
    return static_cast<std::size_t>(row * kSideMax + column);
  }
};

/// What is outside the image is as its edge.
double grey_at(const ImageView& image, double x, double y) {
  const double u = std::clamp(x, 0.0, image.width_px - 1.001);
  const double v = std::clamp(y, 0.0, image.height_px - 1.001);
  const int column = static_cast<int>(u), row = static_cast<int>(v);
  const double right = u - column, down = v - row;
  const std::uint8_t* p = image.pixel(column, row);
  const std::uint8_t* q = p + image.stride;
  return (1.0 - down) * ((1.0 - right) * p[0] + right * p[1]) + down * ((1.0 - right) * q[0] + right * q[1]);
}

Cell look_at(const ImageView& image, const Matrix3d& H, double x, double y) {
  constexpr double kOff = kFromMiddle_cells;
  constexpr std::array<std::array<double, 2>, 5> kPlaces{
      {{0.0, 0.0}, {-kOff, -kOff}, {kOff, -kOff}, {kOff, kOff}, {-kOff, kOff}}};
  Cell cell{0.0, 255.0, 0.0};
  for (const auto& [dx, dy] : kPlaces) {
    const Vector3d p = H * Vector3d(x + dx, y + dy, 1.0);
    const double grey = grey_at(image, p.x() / p.z(), p.y() / p.z());
    cell.grey += grey / static_cast<double>(kPlaces.size());
    cell.darkest = std::min(cell.darkest, grey);
    cell.brightest = std::max(cell.brightest, grey);
  }
  return cell;
}

Cells look(const ImageView& image, const Matrix3d& H, int side) {
  Cells cells;
  cells.side = side;
  const double first = -0.5 * (side - 1);
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      cells(column, row) = look_at(image, H, first + column, first + row);
  return cells;
}

/// Is all of a square about the origin before the camera?
bool is_in_front(const Matrix3d& H, double side) {
  return std::ranges::all_of(corners_of_square(side), [&](const Eigen::Vector2d& corner) {
    return H(2, 0) * corner.x() + H(2, 1) * corner.y() + H(2, 2) > 0.0;
  });
}

/// The grey of the cells of one depth as a plane over the marker: a + b column + c row.
Vector3d plane_of(const Cells& cells, int depth) {
  Matrix3d A = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (int row = 0; row < cells.side; ++row)
    for (int column = 0; column < cells.side; ++column) {
      if (cells.depth(column, row) != depth) continue;
      const Vector3d place(1.0, column, row);
      A += place * place.transpose();
      b += cells(column, row).grey * place;
    }
  return A.inverse() * b;
}

/// Takes from every cell the grey between black and white there; nothing where they are hardly apart.
bool level(Cells& cells) {
  const Vector3d white = plane_of(cells, 0), black = plane_of(cells, 1);
  const double middle = 0.5 * (cells.side - 1);
  if ((white - black).dot(Vector3d(1.0, middle, middle)) < kCellContrastMin_grey) return false;
  for (int row = 0; row < cells.side; ++row)
    for (int column = 0; column < cells.side; ++column) {
      const double between = 0.5 * (white + black).dot(Vector3d(1.0, column, row));
      Cell& cell = cells(column, row);
      cell = {cell.grey - between, cell.darkest - between, cell.brightest - between};
    }
  return true;
}

double sharpened(const Cells& cells, int column, int row) {
  const double grey = cells(column, row).grey;
  const double neighbours = cells(column - 1, row).grey + cells(column + 1, row).grey +
                            cells(column, row - 1).grey + cells(column, row + 1).grey;
  return grey + kSharpening * (4.0 * grey - neighbours);
}

}  // namespace

std::optional<CellReading> read_cells(const ImageView& image, const Corners& corners_px, int bits_per_side) {
  const auto H = homography_of_square(corners_px, bits_per_side + 2);
  if (!H || !is_in_front(*H, bits_per_side + 4)) return std::nullopt;
  Cells cells = look(image, *H, bits_per_side + 4);
  if (!level(cells)) return std::nullopt;
  CellReading reading;
  for (int row = 1; row + 1 < cells.side; ++row)
    for (int column = 1; column + 1 < cells.side; ++column) {
      const bool is_white = sharpened(cells, column, row) > 0.0;
      const Cell& cell = cells(column, row);
      reading.divided += static_cast<int>(cell.darkest < 0.0 && cell.brightest > 0.0);
      if (cells.depth(column, row) == 1)
        reading.wrong_border += static_cast<int>(is_white);
      else
        reading.bits = reading.bits << 1 | static_cast<std::uint64_t>(is_white);
    }
  return reading;
}

}  // namespace waymark::markers
