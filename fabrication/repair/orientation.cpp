#include "fabrication/repair/orientation.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "fabrication/part/edge_table.h"
#include "fabrication/part/triangle_geometry.h"
#include "forward/base/error.h"

namespace mezzotint {

namespace {

using Place = std::array<double, 3>;
using Triangle = std::array<std::uint32_t, 3>;

/// A piece of triangles that hold together through edges.
struct Piece {
  std::vector<std::uint32_t> triangles;
  Place low{}, high{};
  double volume = 0.0;
};

void add_to(Piece& piece, const PartMesh& mesh, std::uint32_t number) {
  const Triangle& triangle = mesh.triangles[number];
  if (piece.triangles.empty()) piece.low = piece.high = mesh.vertices_mm[triangle[0]];
  piece.triangles.push_back(number);
  for (const std::uint32_t corner : triangle) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      piece.low[axis] = std::min(piece.low[axis], mesh.vertices_mm[corner][axis]);
      piece.high[axis] = std::max(piece.high[axis], mesh.vertices_mm[corner][axis]);
    }
  }
}

// About the piece's own corner, so that only its size counts.
double volume_of(const Piece& piece, const PartMesh& mesh) {
  double six_volumes = 0.0;
  for (const std::uint32_t number : piece.triangles) {
    const Place normal = doubled_area_vector(mesh, mesh.triangles[number]);
    const Place& corner = mesh.vertices_mm[mesh.triangles[number][0]];
    for (std::size_t axis = 0; axis < 3; ++axis) six_volumes += (corner[axis] - piece.low[axis]) * normal[axis];
  }
  return six_volumes / 6.0;
}

// Whether each shell bounds a volume by itself, at the edges that it shares with others too.
bool are_closed(const Shells& shells, const EdgeTable& edges) {
  bool closed = true;
  edges.for_each_edge([&](std::uint32_t, std::span<const EdgeTable::Side> sides) {
    if (sides.size() == 2) return;
    for (const EdgeTable::Side side : sides) {
      int balance = 0;
      for (const EdgeTable::Side other : sides)
        if (shells.of_triangle[other.number()] == shells.of_triangle[side.number()])
          balance += other.walks_down() ? 1 : -1;
      closed = closed && balance == 0;
    }
  });
  return closed;
}

std::vector<Piece> pieces_of(const PartMesh& mesh) {
  const EdgeTable edges(mesh);
  Shells shells = find_shells(mesh, edges);
  if (!are_closed(shells, edges)) shells = find_shells(mesh, edges, Join::AnyEdge);
  std::vector<Piece> pieces(shells.count);
  for (std::uint32_t number = 0; number < mesh.triangles.size(); ++number)
    if (shells.of_triangle[number] != Shells::none) add_to(pieces[shells.of_triangle[number]], mesh, number);
  for (Piece& piece : pieces) piece.volume = volume_of(piece, mesh);
  return pieces;
}

bool box_within(const Piece& inner, const Piece& outer) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (inner.low[axis] < outer.low[axis] || inner.high[axis] > outer.high[axis]) return false;
  return true;
}

// Whether the line from `place` along y, within xy, meets the edge; the same answer from both of its triangles.
bool meets(const Place& place, const Place* a, const Place* b) {
  if (((*a)[0] > place[0]) == ((*b)[0] > place[0])) return false;
  if ((*a)[0] > (*b)[0]) std::swap(a, b);
  return place[1] < (*a)[1] + ((*b)[1] - (*a)[1]) * ((place[0] - (*a)[0]) / ((*b)[0] - (*a)[0]));
}

// How many triangles of a piece are above a place, odd or even: on an edge, one of its two.
bool is_inside(const Place& place, const Piece& piece, const PartMesh& mesh) {
  bool inside = false;
  for (const std::uint32_t number : piece.triangles) {
    const Triangle& triangle = mesh.triangles[number];
    const Place& a = mesh.vertices_mm[triangle[0]];
    const Place& b = mesh.vertices_mm[triangle[1]];
    const Place& c = mesh.vertices_mm[triangle[2]];
    if (std::max({a[2], b[2], c[2]}) < place[2]) continue;
    if ((meets(place, &a, &b) != meets(place, &b, &c)) == meets(place, &c, &a)) continue;
    const Place normal = doubled_area_vector(mesh, triangle);
    const double along = normal[0] * (a[0] - place[0]) + normal[1] * (a[1] - place[1]) + normal[2] * (a[2] - place[2]);
    if (normal[2] != 0.0 && (along > 0.0) == (normal[2] > 0.0)) inside = !inside;
  }
  return inside;
}

bool is_within(const Piece& inner, const Piece& outer, const PartMesh& mesh) {
  if (!box_within(inner, outer)) return false;
  constexpr std::size_t samples = 8;
  constexpr Place weights = {0.311, 0.272, 0.417};  // no place that a modeller would choose
  for (std::size_t k = 0; k < samples; ++k) {
    const Triangle& triangle = mesh.triangles[inner.triangles[k * (inner.triangles.size() - 1) / (samples - 1)]];
    Place place{};
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (std::size_t axis = 0; axis < 3; ++axis)
        place[axis] += weights[corner] * mesh.vertices_mm[triangle[corner]][axis];
    if (!is_inside(place, outer, mesh)) return false;
  }
  return true;
}

void turn(PartMesh& mesh, std::uint32_t number) { std::swap(mesh.triangles[number][1], mesh.triangles[number][2]); }

/// Neighbours of triangles across edges of two, and whether they agree.
struct Neighbour {
  std::uint32_t triangle;
  bool agrees;
};
using Neighbours = std::vector<std::array<Neighbour, 3>>;
constexpr std::uint32_t nobody = Shells::none;

Neighbours neighbours_of(const PartMesh& mesh) {
  Neighbours neighbours(mesh.triangles.size(), {{{nobody, true}, {nobody, true}, {nobody, true}}});
  const auto link = [&](std::uint32_t from, Neighbour to) {
    *std::find_if(neighbours[from].begin(), neighbours[from].end(),
                  [](const Neighbour& n) { return n.triangle == nobody; }) = to;
  };
  EdgeTable(mesh).for_each_edge([&](std::uint32_t, std::span<const EdgeTable::Side> sides) {
    if (sides.size() != 2) return;
    const bool agree = sides[0].walks_down() != sides[1].walks_down();
    link(sides[0].number(), {sides[1].number(), agree});
    link(sides[1].number(), {sides[0].number(), agree});
  });
  return neighbours;
}

enum class Side : unsigned char { Unknown, Kept, Turned };

// The shell of `first`, with a side for each of its triangles.
std::vector<std::uint32_t> spread(std::uint32_t first, const Neighbours& neighbours, std::vector<Side>& sides) {
  std::vector<std::uint32_t> shell = {first};
  sides[first] = Side::Kept;
  for (std::size_t k = 0; k < shell.size(); ++k) {
    for (const Neighbour& next : neighbours[shell[k]]) {
      if (next.triangle == nobody) continue;
      const bool turned = (sides[shell[k]] == Side::Turned) == next.agrees;
      const Side wanted = turned ? Side::Turned : Side::Kept;
      if (sides[next.triangle] == Side::Unknown) {
        sides[next.triangle] = wanted;
        shell.push_back(next.triangle);
      } else if (sides[next.triangle] != wanted) {
        throw MethodError(
            "the part has a surface of one side only (as a Möbius strip), which bounds no solid; mend it where it was "
            "modelled");
      }
    }
  }
  return shell;
}

}  // namespace

std::size_t agree_on_sides(PartMesh& mesh) {
  const Neighbours neighbours = neighbours_of(mesh);
  std::vector<Side> sides(mesh.triangles.size(), Side::Unknown);
  std::size_t turned = 0;
  for (std::uint32_t first = 0; first < mesh.triangles.size(); ++first) {
    if (sides[first] != Side::Unknown) continue;
    const std::vector<std::uint32_t> shell = spread(first, neighbours, sides);
    const auto against = static_cast<std::size_t>(
        std::count_if(shell.begin(), shell.end(), [&](std::uint32_t k) { return sides[k] == Side::Turned; }));
    const Side fewer = 2 * against <= shell.size() ? Side::Turned : Side::Kept;
    for (const std::uint32_t number : shell) {
      if (sides[number] != fewer) continue;
      turn(mesh, number);
      ++turned;
    }
  }
  return turned;
}

std::size_t face_outwards(PartMesh& mesh) {
  const std::vector<Piece> pieces = pieces_of(mesh);
  std::vector<std::size_t> wrong;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    std::size_t depth = 0;
    for (std::size_t other = 0; other < pieces.size(); ++other)
      if (other != k && is_within(pieces[k], pieces[other], mesh)) ++depth;
    const bool faces_in = depth % 2 == 1;
    if (pieces[k].volume != 0.0 && (pieces[k].volume < 0.0) != faces_in) wrong.push_back(k);
  }
  for (const std::size_t k : wrong)
    for (const std::uint32_t number : pieces[k].triangles) turn(mesh, number);
  return wrong.size();
}

}  // namespace mezzotint
