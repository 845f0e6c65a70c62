# cmake -DROOT=renderer -DTOOLCHAIN=text -DOUTPUT=file.cpp -P digest_sources.cmake
# Writes a source with the SHA-256 of all code in the folders that decide what a sample is worth; the file is left alone
# if that has not changed.
set(text "")
foreach(folder base math image params scene frame trace reference)
  file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/${folder}/*.cpp ${ROOT}/${folder}/*.h)
  list(SORT files)
  foreach(name IN LISTS files)
    file(SHA256 ${ROOT}/${name} hash)
    string(APPEND text "${name} ${hash}\n")
  endforeach()
endforeach()
string(SHA256 digest "${text}")
set(source "#include \"reference/source_digest.h\"\n\nnamespace lumi {\nconst char* const kSourceDigest = \"${digest}\";
const char* const kToolchain = \"${TOOLCHAIN}\";\n}  // namespace lumi\n")
set(present "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} present)
endif()
if(NOT present STREQUAL source)
  file(WRITE ${OUTPUT} "${source}")
endif()
