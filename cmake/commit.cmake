# cmake -DSOURCE=DIR -DFILE=F -P commit.cmake: writes the commit of the source tree, with "-changed" where the tree differs
# from it, into a file, which is left alone when nothing is new.
execute_process(COMMAND git -C ${SOURCE} describe --always --abbrev=12 --dirty=-changed
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${FILE} CONTENT "commit: ${commit}\n")
