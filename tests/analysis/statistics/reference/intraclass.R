source("reference.R")
suppressMessages(library(psych))

agreement <- function(case, ratings) {
  result <- ICC(ratings, lmer = FALSE)
  r <- result$results
  answer(case, value = r$ICC, low = r[["lower bound"]], high = r[["upper bound"]], f = r$F,
         df_targets = r$df1, df_error = r$df2, p = r$p)
}

procedure("Intraclass correlation", "psych::ICC")
# The table of Shrout and Fleiss 1979: six targets, four judges.
agreement("Shrout and Fleiss", matrix(c(9, 2, 5, 8, 6, 1, 3, 2, 8, 4, 6, 8,
                                        7, 1, 2, 6, 10, 5, 6, 9, 6, 2, 4, 7), 6, byrow = TRUE))
ratings <- data_set("ratings")
agreement("ratings", matrix(ratings$value, ncol = 4, byrow = TRUE))
agreement("pairs", as.matrix(data_set("pairs")))
agreement("tied pairs", as.matrix(data_set("tied_pairs")))
finish()
