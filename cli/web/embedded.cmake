# SPDX-License-Identifier: MIT
# Embeds the pages and the scenes into `target`: an assembly file includes their bytes (.incbin) and has a table of
# names, which cli/web/embedded.cpp reads.

# carry(NAME PATH): embeds the file PATH under NAME.
function(carry name path)
  if(NOT EXISTS ${path})
    message(FATAL_ERROR "${path} is missing.")
  endif()
  set_property(GLOBAL APPEND PROPERTY CARRIED_PATHS ${path})
  get_property(paths GLOBAL PROPERTY CARRIED_PATHS)
  list(LENGTH paths n)
  set_property(GLOBAL APPEND_STRING PROPERTY CARRIED_BYTES
    "name_${n}:\n  .asciz \"${name}\"\nbegin_${n}:\n  .incbin \"${path}\"\nend_${n}:\n")
  set_property(GLOBAL APPEND_STRING PROPERTY CARRIED_TABLE "  .quad name_${n}, begin_${n}, end_${n}\n")
endfunction()

function(embed_web_files target)
  set(web ${PROJECT_SOURCE_DIR}/cli/web)
  if(GATEWALK_PAGES)
    file(GLOB pages CONFIGURE_DEPENDS RELATIVE ${web} ${web}/*.html ${web}/*.css ${web}/*.js)
    foreach(page ${pages})
      carry(${page} ${web}/${page})
    endforeach()
  endif()
  set(scenes ${PROJECT_SOURCE_DIR}/scenes)
  file(GLOB scenes CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${scenes}/*.toml ${scenes}/*.csv
    ${scenes}/tracks/*.toml ${scenes}/tracks/*.csv)
  foreach(scene ${scenes})
    carry(${scene} ${PROJECT_SOURCE_DIR}/${scene})
  endforeach()

  get_property(paths GLOBAL PROPERTY CARRIED_PATHS)
  get_property(bytes GLOBAL PROPERTY CARRIED_BYTES)
  get_property(table GLOBAL PROPERTY CARRIED_TABLE)
  set(assembly ${PROJECT_BINARY_DIR}/generated/cli/embedded.s)
  file(CONFIGURE OUTPUT ${assembly} @ONLY CONTENT [[
  .section .rodata
@bytes@
  .section .data.rel.ro, "aw"
  .balign 8
  .global gatewalk_carried_files
gatewalk_carried_files:
@table@  .quad 0, 0, 0
  .section .note.GNU-stack, "", %progbits
]])
  set_source_files_properties(${assembly} PROPERTIES OBJECT_DEPENDS "${paths}")
  set_source_files_properties(${assembly} PROPERTIES COMPILE_OPTIONS
    $<$<CXX_COMPILER_ID:Clang>:-Wno-unused-command-line-argument>)
  target_sources(${target} PRIVATE ${assembly})
endfunction()
