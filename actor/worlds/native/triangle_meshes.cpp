// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/triangle_meshes.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>

#include "actor/worlds/native/geom_rules.h"
#include "actor/worlds/native/screen_bounds.h"

namespace shoal::worlds::native {
namespace {

// If the cosine between a corner's normal and the face's is below this, the engine takes the
// face's.
constexpr double kSmooth = 0.8;

Vector3 FaceNormal(const Vector3& a, const Vector3& b, const Vector3& c) {
  return Normalized(Cross(b - a, c - a));
}

void Append(Vector3 v, std::vector<float>* to) {
  to->insert(to->end(),
             {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
}

// Adds a triangle that has its face's normal at all corners.
void AddFlat(const std::array<Vector3, 3>& corners, Vector3 normal, TriangleMesh* mesh) {
  for (const Vector3& corner : corners) {
    Append(corner, &mesh->positions);
    Append(normal, &mesh->normals);
  }
}

void AddQuad(const std::array<Vector3, 4>& q, Vector3 normal, TriangleMesh* mesh) {
  AddFlat({q[0], q[1], q[3]}, normal, mesh);
  AddFlat({q[1], q[2], q[3]}, normal, mesh);
}

// vertices: three indices for each face, relative to the mesh's first vertex.
TriangleMesh MakeMesh(const mjModel& model, int id, const int* vertices, int faces, bool hull) {
  TriangleMesh mesh;
  const int first = model.mesh_vertadr[id], coords = model.mesh_texcoordadr[id];
  for (int face = 0; face < faces; ++face) {
    std::array<Vector3, 3> corners, normals;
    for (size_t i = 0; i < 3; ++i) {
      const int vertex = vertices[3 * face + static_cast<int>(i)];
      corners[i] = FromFloats(model.mesh_vert + 3 * (first + vertex));
      normals[i] = FromFloats(model.mesh_normal + 3 * (first + vertex));
      if (coords < 0) continue;
      const float* texture = model.mesh_texcoord + 2 * (coords + vertex);
      mesh.coords.insert(mesh.coords.end(), {texture[0], texture[1]});
    }
    const Vector3 flat = FaceNormal(corners[0], corners[1], corners[2]);
    for (size_t i = 0; i < 3; ++i) {
      const bool sharp = hull || (coords < 0 && Dot(normals[i], flat) < kSmooth);
      Append(corners[i], &mesh.positions);
      Append(sharp ? flat : normals[i], &mesh.normals);
    }
  }
  return mesh;
}

// Surface, sides and bottom of a height field.
class HeightField {
 public:
  HeightField(const mjModel& model, int id)
      : rows_(model.hfield_nrow[id]),
        columns_(model.hfield_ncol[id]),
        size_(model.hfield_size + 4 * id),
        data_(model.hfield_data + model.hfield_adr[id]) {}

  TriangleMesh Triangles() const {
    TriangleMesh mesh;
    AddTop(&mesh);
    for (int r = 0; r + 1 < rows_; ++r) {
      AddQuad({Bottom(r + 1, 0), Bottom(r, 0), Top(r, 0), Top(r + 1, 0)}, {-1, 0, 0}, &mesh);
      const int c = columns_ - 1;
      AddQuad({Bottom(r, c), Bottom(r + 1, c), Top(r + 1, c), Top(r, c)}, {1, 0, 0}, &mesh);
    }
    for (int c = 0; c + 1 < columns_; ++c) {
      AddQuad({Bottom(0, c), Bottom(0, c + 1), Top(0, c + 1), Top(0, c)}, {0, -1, 0}, &mesh);
      const int r = rows_ - 1;
      AddQuad({Bottom(r, c + 1), Bottom(r, c), Top(r, c), Top(r, c + 1)}, {0, 1, 0}, &mesh);
    }
    AddQuad({Bottom(0, 0), Bottom(rows_ - 1, 0), Bottom(rows_ - 1, columns_ - 1),
             Bottom(0, columns_ - 1)},
            {0, 0, -1}, &mesh);
    return mesh;
  }

 private:
  Vector3 At(int row, int column, double z) const {
    return {size_[0] * (2.0 * column / (columns_ - 1) - 1),
            size_[1] * (2.0 * row / (rows_ - 1) - 1), z};
  }
  Vector3 Top(int row, int column) const {
    return At(row, column, size_[2] * double{data_[row * columns_ + column]});
  }
  Vector3 Bottom(int row, int column) const { return At(row, column, -size_[3]); }

  // The surface consists of strips of triangles, each with its own normal.
  void AddTop(TriangleMesh* mesh) const {
    const auto add = [mesh](const Vector3& a, const Vector3& b, const Vector3& c) {
      AddFlat({a, b, c}, FaceNormal(a, b, c), mesh);
    };
    for (int r = 0; r + 1 < rows_; ++r) {
      for (int c = 0; c + 1 < columns_; ++c) {
        add(Top(r + 1, c), Top(r, c), Top(r + 1, c + 1));
        add(Top(r, c), Top(r, c + 1), Top(r + 1, c + 1));
      }
    }
  }

  int rows_, columns_;
  const mjtNum* size_;
  const float* data_;
};

constexpr std::array<int, 2> kEdges[] = {{0, 1}, {1, 2}, {2, 0}};

void Grow(const TileRect& by, TileRect* rect) {
  *rect = {std::min(rect->left, by.left), std::min(rect->top, by.top),
           std::max(rect->right, by.right), std::max(rect->bottom, by.bottom)};
}

Affine About(Vector3 a, float x, float y) {
  return {static_cast<float>(a.x * x + a.y * y + a.z), static_cast<float>(a.x),
          static_cast<float>(a.y)};
}

}  // namespace

TriangleMeshes::TriangleMeshes(const mjModel& model) {
  for (int i = 0; i < model.ngeom; ++i) {
    const int id = model.geom_dataid[i];
    if (id < 0 || !GroupIsShown(model.geom_group[i])) continue;
    if (model.geom_type[i] == mjGEOM_HFIELD) {
      hfields_.emplace(id, HeightField(model, id).Triangles());
    } else if (model.geom_type[i] == mjGEOM_MESH && meshes_.count(2 * id) == 0) {
      meshes_.emplace(2 * id, MakeMesh(model, id, model.mesh_face + 3 * model.mesh_faceadr[id],
                                       model.mesh_facenum[id], /*hull=*/false));
      const int graph = model.mesh_graphadr[id];
      if (graph < 0) continue;
      const int vertices = model.mesh_graph[graph], faces = model.mesh_graph[graph + 1];
      const int* hull = model.mesh_graph + graph + 2 + 3 * vertices + 3 * faces;
      meshes_.emplace(2 * id + 1, MakeMesh(model, id, hull, faces, /*hull=*/true));
    }
  }
}

const TriangleMesh* TriangleMeshes::Find(const mjvGeom& geom) const {
  const auto& from = geom.type == mjGEOM_HFIELD ? hfields_ : meshes_;
  const auto found = from.find(geom.dataid);
  return found == from.end() ? nullptr : &found->second;
}

bool MakeTriangles(const TriangleMesh& mesh, const PlacedGeom& placed, const CameraFrame& frame,
                   const View& view, int id, std::vector<Triangle>* triangles, Shape* shape) {
  triangles->clear();
  *shape = Shape{};
  shape->kind = kTriangles;
  shape->id = id;
  shape->rect = {view.tiles_x, view.tiles_y, 0, 0};
  for (int i = 0; i < mesh.size(); ++i) {
    std::array<Vector3, 3> v;
    for (size_t k = 0; k < 3; ++k) {
      const float* p = mesh.positions.data() + 9 * static_cast<size_t>(i) + 3 * k;
      v[k] = placed.centre + double{p[0]} * placed.axes[0] + double{p[1]} * placed.axes[1] +
             double{p[2]} * placed.axes[2];
    }
    // A ray is (v0 b0 + v1 b1 + v2 b2) times its depth. By the rows of the inverse, each b times w
    // is affine and w is their sum. A ray with all three b above zero meets the triangle, so
    // nothing is clipped at the near plane.
    const Vector3 rows[3] = {Cross(v[1], v[2]), Cross(v[2], v[0]), Cross(v[0], v[1])};
    const double determinant = Dot(rows[0], v[0]);
    if (determinant <= 1e-300) continue;  // seen from behind or edge on
    Triangle triangle;
    if (!TilesOf(BoundHull(v, kEdges, frame.near), frame, view, &triangle.rect)) continue;
    triangle.index = i;
    const bool ahead = v[0].z > frame.near;
    triangle.x = ahead ? static_cast<float>(v[0].x / v[0].z) : 0;
    triangle.y = ahead ? static_cast<float>(v[0].y / v[0].z) : 0;
    Vector3 sum;
    for (size_t k = 0; k < 3; ++k) {
      const Vector3 row = (1 / determinant) * rows[k];
      sum = sum + row;
      triangle.edges[k] = About(row, triangle.x, triangle.y);
    }
    triangle.w = About(sum, triangle.x, triangle.y);
    Grow(triangle.rect, &shape->rect);
    triangles->push_back(triangle);
  }
  shape->triangles = static_cast<int>(triangles->size());
  shape->triangle = triangles->data();
  return !triangles->empty();
}

}  // namespace shoal::worlds::native
