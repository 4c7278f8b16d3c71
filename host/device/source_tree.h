/* source_tree.h: finding a kernel source; private to source*.c. */
#ifndef CANDELA_DEVICE_SOURCE_TREE_H
#define CANDELA_DEVICE_SOURCE_TREE_H

/* The folder that replaces the embedded sources, or NULL. */
const char *source_root(void);

/* The text of a source, to be freed; NULL with errno set, nothing logged. */
char *source_find(const char *path);

#endif
