#include "fabrication/part/three_mf_input.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include <Model/COM/NMR_DLLInterfaces.h>
#include <fmt/format.h>

#include "fabrication/part/three_mf_package.h"
#include "forward/base/error.h"
#include "forward/base/file_input.h"

namespace mezzotint {

namespace {

// Rows of a 3 × 4 matrix: places are columns.
using Transform = std::array<std::array<double, 4>, 3>;
constexpr Transform identity = {{{1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}, {0.0, 0.0, 1.0, 0.0}}};

constexpr std::size_t most_triangles = std::size_t{1} << 28U;
constexpr unsigned deepest = 64;

struct Release {
  void operator()(void* handle) const { NMR::lib3mf_release(static_cast<NMR::PLib3MFBase*>(handle)); }
};
using Handle = std::unique_ptr<void, Release>;

template <class Interface>
Interface* as(const Handle& handle) {
  return static_cast<Interface*>(handle.get());
}

Transform transform_of(const NMR::MODELTRANSFORM& from) {
  Transform transform{};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 4; ++column) transform[row][column] = double{from.m_fFields[row][column]};
  return transform;
}

// First `inner`, then `outer`.
Transform joined(const Transform& outer, const Transform& inner) {
  Transform transform{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      double sum = column == 3 ? outer[row][3] : 0.0;
      for (std::size_t k = 0; k < 3; ++k) sum += outer[row][k] * inner[k][column];
      transform[row][column] = sum;
    }
  }
  return transform;
}

bool mirrors(const Transform& t) {
  return t[0][0] * (t[1][1] * t[2][2] - t[1][2] * t[2][1]) - t[0][1] * (t[1][0] * t[2][2] - t[1][2] * t[2][0]) +
             t[0][2] * (t[1][0] * t[2][1] - t[1][1] * t[2][0]) <
         0.0;
}

/// The library's model of a file, and what is made of it.
class ThreeMf {
public:
  ThreeMf(const std::filesystem::path& path, std::vector<std::string>& notes) : path_(path), notes_(notes) {
    void* model = nullptr;
    if (NMR::lib3mf_createmodel(reinterpret_cast<NMR::PLib3MFModel**>(&model)) != LIB3MF_OK)
      throw MethodError("the library for 3MF does not start");
    model_.reset(model);
  }

  RawMesh read() {
    load();
    raw_.format = "3mf";
    raw_.unit = unit();
    const Handle items = made([&](void** to) {
      return NMR::lib3mf_model_getbuilditems(model(), reinterpret_cast<NMR::PLib3MFModelBuildItemIterator**>(to));
    });
    auto* iterator = as<NMR::PLib3MFModelBuildItemIterator>(items);
    for (;;) {
      BOOL more = 0;
      check(NMR::lib3mf_builditemiterator_movenext(iterator, &more));
      if (more == 0) break;
      add_item(made([&](void** to) {
        return NMR::lib3mf_builditemiterator_getcurrent(iterator, reinterpret_cast<NMR::PLib3MFModelBuildItem**>(to));
      }));
    }
    if (raw_.group_names.empty()) fail("has no item to build; a 3MF of a part names one");
    return std::move(raw_);
  }

private:
  [[nodiscard]] NMR::PLib3MFModel* model() const { return as<NMR::PLib3MFModel>(model_); }
  [[noreturn]] void fail(const std::string& problem) const { throw FileError(path_, "", problem); }

  void check(LIB3MFRESULT result) const {
    if (result == LIB3MF_OK) return;
    DWORD code = 0;
    LPCSTR message = nullptr;
    NMR::lib3mf_getlasterror(as<NMR::PLib3MFBase>(model_), &code, &message);
    fail(fmt::format("cannot be read as 3MF: {} (lib3mf {:#x})", message != nullptr ? message : "", code));
  }

  template <class Make>
  Handle made(const Make& make) const {
    void* made = nullptr;
    check(make(&made));
    if (made == nullptr) fail("cannot be read as 3MF: an object is missing");
    return Handle(made);
  }

  void load() {
    std::vector<std::byte> bytes = read_file(path_);
    check_three_mf_package(path_, bytes);
    const Handle reader = made([&](void** to) {
      return NMR::lib3mf_model_queryreader(model(), "3mf", reinterpret_cast<NMR::PLib3MFModelReader**>(to));
    });
    auto* reading = as<NMR::PLib3MFModelReader>(reader);
    const LIB3MFRESULT result =
        NMR::lib3mf_reader_readfrombuffer(reading, reinterpret_cast<BYTE*>(bytes.data()), bytes.size());
    if (result != LIB3MF_OK) {
      DWORD code = 0;
      LPCSTR message = nullptr;
      NMR::lib3mf_getlasterror(as<NMR::PLib3MFBase>(reader), &code, &message);
      fail(fmt::format("is no 3MF that can be read: {} (lib3mf {:#x})", message != nullptr ? message : "", code));
    }
    take_warnings(reading);
  }

  void take_warnings(NMR::PLib3MFModelReader* reader) {
    constexpr DWORD most = 10000;
    DWORD count = 0;
    check(NMR::lib3mf_reader_getwarningcount(reader, &count));
    std::map<std::string, DWORD> times;
    for (DWORD k = 0; k < std::min(count, most); ++k) {
      std::array<char, 512> text{};
      DWORD code = 0;
      ULONG needed = 0;
      if (NMR::lib3mf_reader_getwarningutf8(reader, k, &code, text.data(), text.size() - 1, &needed) != LIB3MF_OK)
        text[0] = '\0';
      ++times[fmt::format("lib3mf warns: {} ({:#x})", text.data(), code)];
    }
    for (const auto& [warning, number] : times)
      notes_.push_back(number == 1 ? warning : fmt::format("{}, {} times", warning, number));
    if (count > most) notes_.push_back(fmt::format("lib3mf warns of {} more", count - most));
  }

  [[nodiscard]] Length unit() const {
    DWORD unit = 0;
    check(NMR::lib3mf_model_getunit(model(), &unit));
    switch (unit) {
      case NMR::MODELUNIT_MICROMETER:
        return Length::from_um(1.0);
      case NMR::MODELUNIT_MILLIMETER:
        return Length::from_mm(1.0);
      case NMR::MODELUNIT_CENTIMETER:
        return Length::from_mm(10.0);
      case NMR::MODELUNIT_INCH:
        return Length::from_mm(25.4);
      case NMR::MODELUNIT_FOOT:
        return Length::from_mm(304.8);
      case NMR::MODELUNIT_METER:
        return Length::from_m(1.0);
      default:
        fail(fmt::format("has unit number {}, which is none of 3MF", unit));
    }
  }

  void add_item(const Handle& item) {
    auto* build_item = as<NMR::PLib3MFModelBuildItem>(item);
    NMR::MODELTRANSFORM transform{};
    BOOL has_transform = 0;
    check(NMR::lib3mf_builditem_hasobjecttransform(build_item, &has_transform));
    if (has_transform != 0) check(NMR::lib3mf_builditem_getobjecttransform(build_item, &transform));
    const Handle object = made([&](void** to) {
      return NMR::lib3mf_builditem_getobjectresource(build_item,
                                                     reinterpret_cast<NMR::PLib3MFModelObjectResource**>(to));
    });
    raw_.group_names.push_back(name_of(object));
    add_object(object, has_transform != 0 ? transform_of(transform) : identity, 0);
  }

  std::string name_of(const Handle& object) const {
    std::array<char, 512> name{};
    ULONG needed = 0;
    if (NMR::lib3mf_object_getnameutf8(as<NMR::PLib3MFModelObjectResource>(object), name.data(), name.size() - 1,
                                       &needed) != LIB3MF_OK)
      name[0] = '\0';
    const std::string number = std::to_string(raw_.group_names.size() + 1);
    return name[0] != '\0' ? std::string(name.data()) : "item " + number;
  }

  void add_object(const Handle& object, const Transform& transform, unsigned depth) {
    if (++instances_ > most_instances || depth > deepest)
      fail(fmt::format("has components in components that make more than {} objects, or deeper than {}", most_instances,
                       deepest));
    auto* resource = as<NMR::PLib3MFModelObjectResource>(object);
    BOOL is_mesh = 0;
    check(NMR::lib3mf_object_ismeshobject(resource, &is_mesh));
    if (is_mesh != 0) {
      add_mesh(as<NMR::PLib3MFModelMeshObject>(object), transform);
      return;
    }
    auto* components = as<NMR::PLib3MFModelComponentsObject>(object);
    DWORD count = 0;
    check(NMR::lib3mf_componentsobject_getcomponentcount(components, &count));
    for (DWORD k = 0; k < count; ++k) {
      add_component(made([&](void** to) {
                      return NMR::lib3mf_componentsobject_getcomponent(
                          components, k, reinterpret_cast<NMR::PLib3MFModelComponent**>(to));
                    }),
                    transform, depth);
    }
  }

  void add_component(const Handle& handle, const Transform& outer, unsigned depth) {
    auto* component = as<NMR::PLib3MFModelComponent>(handle);
    NMR::MODELTRANSFORM transform{};
    BOOL has_transform = 0;
    check(NMR::lib3mf_component_hastransform(component, &has_transform));
    if (has_transform != 0) check(NMR::lib3mf_component_gettransform(component, &transform));
    const Handle object = made([&](void** to) {
      return NMR::lib3mf_component_getobjectresource(component,
                                                     reinterpret_cast<NMR::PLib3MFModelObjectResource**>(to));
    });
    add_object(object, has_transform != 0 ? joined(outer, transform_of(transform)) : outer, depth + 1);
  }

  void add_mesh(NMR::PLib3MFModelMeshObject* mesh, const Transform& transform) {
    DWORD vertices = 0, triangles = 0;
    check(NMR::lib3mf_meshobject_getvertexcount(mesh, &vertices));
    check(NMR::lib3mf_meshobject_gettrianglecount(mesh, &triangles));
    if (raw_.triangles.size() + triangles > most_triangles || raw_.vertices.size() + vertices > most_triangles)
      fail("makes more than 2^28 triangles of its components");
    const std::size_t first = raw_.vertices.size();
    for (DWORD k = 0; k < vertices; ++k) {
      NMR::MODELMESHVERTEX vertex{};
      check(NMR::lib3mf_meshobject_getvertex(mesh, k, &vertex));
      std::array<double, 3> place{};
      for (std::size_t row = 0; row < 3; ++row) {
        place[row] = transform[row][3];
        for (std::size_t axis = 0; axis < 3; ++axis)
          place[row] += transform[row][axis] * double{vertex.m_fPosition[axis]};
        if (!std::isfinite(place[row])) fail(fmt::format("has vertex {} of an object at no finite place", k));
      }
      raw_.vertices.push_back(place);
    }
    add_triangles(mesh, triangles, {first, vertices}, mirrors(transform));
    raw_.groups.resize(raw_.triangles.size(), static_cast<std::uint32_t>(raw_.group_names.size() - 1));
  }

  /// The vertices of one object among those of all.
  struct Range {
    std::size_t first;
    DWORD count;
  };
  /// @param mirrored its transform turns triangles inside out
  void add_triangles(NMR::PLib3MFModelMeshObject* mesh, DWORD triangles, Range vertices, bool mirrored) {
    for (DWORD k = 0; k < triangles; ++k) {
      NMR::MODELMESHTRIANGLE triangle{};
      check(NMR::lib3mf_meshobject_gettriangle(mesh, k, &triangle));
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t corner = 0; corner < 3; ++corner) {
        if (triangle.m_nIndices[corner] >= vertices.count)
          fail(fmt::format("has triangle {} of an object that names vertex {} of {}", k, triangle.m_nIndices[corner],
                           vertices.count));
        corners[corner] = static_cast<std::uint32_t>(vertices.first + triangle.m_nIndices[corner]);
      }
      if (mirrored) std::swap(corners[1], corners[2]);
      raw_.triangles.push_back(corners);
    }
  }

  const std::filesystem::path& path_;
  std::vector<std::string>& notes_;
  Handle model_;
  RawMesh raw_;
  std::size_t instances_ = 0;
};

}  // namespace

RawMesh read_three_mf(const std::filesystem::path& path, std::vector<std::string>& notes) {
  return ThreeMf(path, notes).read();
}

}  // namespace mezzotint
