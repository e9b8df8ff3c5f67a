# Puts the pages, their script libraries and the scenes into `target`: an assembly file takes the bytes in
# as they are (.incbin), with a table of names that cli/web/embedded.cpp reads.

# carry(NAME PATH): the program knows the file PATH as NAME.
function(carry name path)
  if(NOT EXISTS ${path})
    message(FATAL_ERROR "${path} is missing. The pages' script libraries come from npm, once:\n"
      "  npm ci --ignore-scripts --prefix cli/web\n./demo.sh and ./test.sh do it by themselves.")
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
  set(npm ${web}/node_modules)
  carry(vega.min.js ${npm}/vega/build/vega.min.js)
  carry(vega-lite.min.js ${npm}/vega-lite/build/vega-lite.min.js)
  carry(vega-embed.min.js ${npm}/vega-embed/build/vega-embed.min.js)
  carry(plotly-gl3d.min.js ${npm}/plotly.js-gl3d-dist-min/plotly-gl3d.min.js)
  carry(vega.LICENSE ${npm}/vega/LICENSE)
  carry(vega-lite.LICENSE ${npm}/vega-lite/LICENSE)
  carry(vega-embed.LICENSE ${npm}/vega-embed/LICENSE)
  carry(plotly.LICENSE ${npm}/plotly.js-gl3d-dist-min/LICENSE)
  file(GLOB pages CONFIGURE_DEPENDS RELATIVE ${web} ${web}/*.html ${web}/*.css ${web}/*.js)
  foreach(page ${pages})
    carry(${page} ${web}/${page})
  endforeach()
  file(GLOB scenes CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/scenes/*.toml)
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
