// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/osmesa_library.h"

#include <dlfcn.h>

#include "common/base/error.h"

namespace shoal::worlds {
namespace {

constexpr char kFile[] = "libOSMesa.so.8";

template <typename Function>
void Find(void* library, const char* name, Function* function) {
  *function = reinterpret_cast<Function>(dlsym(library, name));
  if (*function == nullptr) throw RuntimeError("{} has no function {}", kFile, name);
}

}  // namespace

OsmesaLibrary OpenOsmesa(const char* file) {
  // RTLD_GLOBAL, because the engine looks for OSMesaGetProcAddress among the process's symbols.
  void* library = dlopen(file, RTLD_NOW | RTLD_GLOBAL);
  if (library == nullptr) {
    throw RuntimeError(
        "qualities fast and reference are drawn by OSMesa, which cannot be opened ({}); install "
        "the package libosmesa6, or choose quality native (observation.quality=native)",
        dlerror());
  }
  OsmesaLibrary found;
  Find(library, "OSMesaCreateContextExt", &found.create_context);
  Find(library, "OSMesaMakeCurrent", &found.make_current);
  Find(library, "OSMesaGetCurrentContext", &found.current_context);
  Find(library, "OSMesaDestroyContext", &found.destroy_context);
  Find(library, "OSMesaGetProcAddress", &found.proc_address);
  const auto find_gl = [&found](const char* name, auto* function) {
    *function =
        reinterpret_cast<std::remove_pointer_t<decltype(function)>>(found.proc_address(name));
    if (*function == nullptr) throw RuntimeError("OSMesa has no function {}", name);
  };
  find_gl("glBindTexture", &found.bind_texture);
  find_gl("glTexParameteri", &found.tex_parameter);
  find_gl("glGenLists", &found.gen_lists);
  find_gl("glNewList", &found.new_list);
  find_gl("glEndList", &found.end_list);
  find_gl("glBegin", &found.begin);
  find_gl("glEnd", &found.end);
  find_gl("glNormal3fv", &found.normal);
  find_gl("glVertex3fv", &found.vertex);
  return found;
}

const OsmesaLibrary& Osmesa() {
  static const OsmesaLibrary library = OpenOsmesa(kFile);
  return library;
}

}  // namespace shoal::worlds
