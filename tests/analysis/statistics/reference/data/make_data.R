# The committed data sets, made once. Values are multiples of 1/64: adding 1e12 to them is exact,
# so that a result must not depend on such an offset. Needs no package.
set.seed(20061, kind = "Mersenne-Twister", normal.kind = "Inversion", sample.kind = "Rejection")
whole <- function(x) round(x * 64) / 64
keep <- function(data, name) {
  for (column in names(data)) if (is.numeric(data[[column]])) {
    data[[column]] <- sub("\\.?0+$", "", sprintf("%.6f", data[[column]]))
  }
  write.csv(data, paste0(name, ".csv"), row.names = FALSE, quote = FALSE)
}

# Twelve participants in two groups of different size, three conditions, 24 trials each in eight
# blocks of three repetitions; recall error in mN. Conditions and groups differ; differences between
# participants, and of participants between conditions, are as large as the effects.
subject <- sprintf("P%02d", 1:12)
group <- rep(c("expert", "novice"), c(5, 7))
conditions <- c("haptic", "visual", "visuohaptic")
study <- expand.grid(trial = 1:24, condition = conditions, subject = subject)
study$group <- group[match(study$subject, subject)]
study$block <- (study$trial - 1) %/% 3 + 1
study$repetition <- paste0("r", (study$trial - 1) %% 3 + 1)
level <- rnorm(12, 0, 60)[match(study$subject, subject)]
response <- matrix(rnorm(36, 0, c(45, 25, 10)), 12, byrow = TRUE)
study$score <- 400 + level + c(40, 5, -25)[study$condition] +
  ifelse(study$group == "expert", -50, 10) * c(0.4, 1, 1.3)[study$condition] +
  response[cbind(match(study$subject, subject), as.integer(study$condition))] -
  12 * (study$repetition == "r2") - 20 * (study$repetition == "r3") * c(0.5, 1, 1.5)[study$condition]
study$score <- whole(study$score + 55 * rgamma(nrow(study), 2) - 110)
keep(study[c("subject", "group", "condition", "trial", "block", "repetition", "score")], "study")

# Groups of different size and spread, without ties.
unequal <- data.frame(group = rep(c("a", "b", "c", "d"), c(5, 9, 3, 12)))
unequal$value <- whole(rnorm(29, c(10, 12, 15, 11)[factor(unequal$group)],
                             c(1, 3, 2, 1.5)[factor(unequal$group)]))
stopifnot(!anyDuplicated(unequal$value))
keep(unequal, "unequal")
unequal$value <- unequal$value + 1e12
keep(unequal, "offset")

# Ratings from 1 to 7, full of ties.
ties <- data.frame(group = rep(c("a", "b", "c"), c(11, 8, 14)))
ties$value <- pmin(7, pmax(1, round(rnorm(33, c(3, 4, 4.6)[factor(ties$group)], 1.4))))
keep(ties, "ties")

# Pairs, without and with ties and equal pairs; the long ones pass R's limit for exact p values.
repeat {
  pairs <- data.frame(first = whole(rnorm(14, 20, 4)))
  pairs$second <- whole(pairs$first + rnorm(14, 1.5, 2.5))
  if (!anyDuplicated(abs(pairs$first - pairs$second)) && !anyDuplicated(unlist(pairs))) break
}
keep(pairs, "pairs")
keep(data.frame(first = sample(1:7, 18, TRUE), second = sample(2:7, 18, TRUE)), "tied_pairs")
long <- data.frame(first = whole(rnorm(64, 100, 30)))
long$second <- whole(long$first + rnorm(64, 6, 20))
keep(long, "long_pairs")

# One value per participant and condition, covariances far from spherical, three unequal groups.
times <- expand.grid(condition = c("c1", "c2", "c3", "c4"), subject = sprintf("S%02d", 1:13))
times$group <- rep(c("g1", "g2", "g3"), c(6, 4, 3))[as.integer(times$subject)]
drift <- rnorm(13, 0, 3)[as.integer(times$subject)]
times$value <- whole(30 + rnorm(13, 0, 5)[as.integer(times$subject)] +
                       (1 + drift) * (as.integer(times$condition) - 1)^1.5 / 2 +
                       2 * (times$group == "g2") + rnorm(nrow(times)))
keep(times[c("subject", "group", "condition", "value")], "times")

# Ratings of ten participants in four conditions.
ratings <- expand.grid(condition = c("c1", "c2", "c3", "c4"), subject = sprintf("S%02d", 1:10))
ratings$value <- pmin(5, pmax(1, round(rnorm(40, 2 + 0.5 * as.integer(ratings$condition), 1))))
keep(ratings[c("subject", "condition", "value")], "ratings")
