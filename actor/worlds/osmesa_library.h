// SPDX-License-Identifier: Apache-2.0
// OSMesa, opened at run time: programs start without it and need it only for the qualities that it
// draws.
#pragma once

#include <GL/gl.h>
#include <GL/osmesa.h>

namespace shoal::worlds {

// Functions of the library that Shoal calls itself. The engine finds its own there, too.
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

// Opened once per process, then kept. Any thread. Throws Error (kRuntime) in one line that says
// which package to install and which quality does without it.
const OsmesaLibrary& Osmesa();

// Opens the library of this file name; for Osmesa() and its test.
OsmesaLibrary OpenOsmesa(const char* file);

}  // namespace shoal::worlds
