// SPDX-License-Identifier: Apache-2.0
// The OSMesa library, opened at run time. Programs start without OSMesa. Only the qualities fast
// and reference need OSMesa.
#pragma once

#include <GL/gl.h>
#include <GL/osmesa.h>

namespace shoal::worlds {

// Functions of OSMesa that Shoal calls. The engine looks up its own functions.
struct OsmesaLibrary {
  decltype(&OSMesaCreateContextExt) create_context;
  decltype(&OSMesaMakeCurrent) make_current;
  decltype(&OSMesaGetCurrentContext) current_context;
  decltype(&OSMesaDestroyContext) destroy_context;
  decltype(&OSMesaGetProcAddress) proc_address;
  decltype(&glBindTexture) bind_texture;
  decltype(&glTexParameteri) tex_parameter;
  decltype(&glGenLists) gen_lists;
  decltype(&glNewList) new_list;
  decltype(&glEndList) end_list;
  decltype(&glBegin) begin;
  decltype(&glEnd) end;
  decltype(&glNormal3fv) normal;
  decltype(&glVertex3fv) vertex;
};

// The library, opened once per process and then kept open. Any thread. If the library cannot be
// opened, throws Error (kRuntime) in one line that names the package to install and the quality
// that does not need OSMesa.
const OsmesaLibrary& Osmesa();

// Opens the library of this file name; used by Osmesa() and its test.
OsmesaLibrary OpenOsmesa(const char* file);

}  // namespace shoal::worlds
