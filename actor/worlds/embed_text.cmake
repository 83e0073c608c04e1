# SPDX-License-Identifier: Apache-2.0
# Writes a C++ source that holds text files:
#   cmake -DOUTPUT=models.cpp "-DINPUTS=a.xml;b.xml" -P embed_text.cmake
# Each file becomes a raw string literal, so none may contain the delimiter )mjcf" itself.
set(source "#include \"actor/worlds/model_files.h\"\n\nnamespace shoal::worlds {\nnamespace {\n\n")
string(APPEND source "constexpr ModelFile kFiles[] = {\n")
foreach(input IN LISTS INPUTS)
  get_filename_component(name "${input}" NAME)
  file(READ "${input}" text)
  string(APPEND source "    {\"${name}\", R\"mjcf(${text})mjcf\"},\n")
endforeach()
string(APPEND source "};\n\n}  // namespace\n\n")
string(APPEND source "std::span<const ModelFile> EmbeddedModelFiles() { return kFiles; }\n\n")
string(APPEND source "}  // namespace shoal::worlds\n")
file(WRITE "${OUTPUT}" "${source}")
