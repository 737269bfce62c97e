# Writes the header that says what plug-ins must be built for: the program's version and a checksum
# of all headers. cmake -DFOLDER= -DVERSION= -DOUT= -P plugin-abi.cmake
set(hashes "")
foreach(layer core protocols analysis experiments)
  file(GLOB_RECURSE headers RELATIVE ${FOLDER} ${FOLDER}/${layer}/*.h)
  list(SORT headers)
  foreach(header ${headers})
    file(SHA256 ${FOLDER}/${header} hash)
    string(APPEND hashes "${header} ${hash}\n")
  endforeach()
endforeach()
string(SHA256 all "${hashes}")
string(SUBSTRING ${all} 0 12 all)
file(CONFIGURE OUTPUT ${OUT} CONTENT
     "#pragma once\n\n#define HAPTRIAL_PLUGIN_HEADERS \"${VERSION}, headers ${all}\"\n")
