/* SPDX-License-Identifier: MIT */
/* A text file in memory, as lines. What is no text is refused by the name of what it is. */
#ifndef SHARED_TABLES_TEXT_FILE_H
#define SHARED_TABLES_TEXT_FILE_H
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct span { /* of characters; not ended by '\0' */
    const char *start, *end;
};

struct text_file {
    char *data;
    size_t size, next; /* where the next line begins */
    int64_t line;      /* of the line read last, from 1 */
};

/* UTF-8, Latin-1, UTF-16. false: `reason` says in a line what is wrong, and the file is empty. */
bool text_file_read(struct text_file *file, const char *path, char *reason, size_t reason_size);
void text_file_destroy(struct text_file *file);

/* The next line without its end, which is that of Unix, Windows or the old Macintosh; false: there
 * is none. */
bool text_file_line(struct text_file *file, struct span *line);
void text_file_rewind(struct text_file *file);

struct span span_trim(struct span span); /* without blanks at both ends */
/* Whether it begins so, in capitals or not. */
bool span_begins(struct span span, const char *word);
#endif
