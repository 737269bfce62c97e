source("reference.R")

study <- data_set("study")
means <- tapply(study$score, study[c("subject", "condition")], mean)
sets <- list(pairs = as.list(data_set("pairs")), "long pairs" = as.list(data_set("long_pairs")),
             "tied pairs" = as.list(data_set("tied_pairs")),
             "eight pairs" = as.list(head(data_set("pairs"), 8)),
             participants = list(means[, "visual"], means[, "visuohaptic"]))

procedure("Pearson correlation", "cor.test(method = 'pearson')")
for (case in names(sets)) {
  test <- cor.test(sets[[case]][[1]], sets[[case]][[2]])
  answer(case, r = test$estimate, p = test$p.value, low = test$conf.int[1], high = test$conf.int[2])
}

procedure("Spearman correlation", "cor.test(method = 'spearman')")
for (case in names(sets)) {
  a <- sets[[case]][[1]]
  b <- sets[[case]][[2]]
  exact <- !anyDuplicated(a) && !anyDuplicated(b)
  test <- cor.test(a, b, method = "spearman", exact = exact)
  r <- unname(test$estimate)
  half <- qnorm(0.975) * sqrt((1 + r^2 / 2) / (length(a) - 3))  # Bonett and Wright 2000
  answer(case, r = r, p = test$p.value, low = tanh(atanh(r) - half), high = tanh(atanh(r) + half))
}

# With ties and few pairs the truth is in all arrangements.
arrangements <- function(n) {
  if (n == 1) return(matrix(1))
  less <- arrangements(n - 1)
  do.call(rbind, lapply(1:n, function(k) cbind(k, less + (less >= k))))
}
procedure("Spearman correlation of few tied pairs", "cor(rank) over all arrangements")
for (n in c(5, 8)) {
  tied <- head(data_set("tied_pairs"), n)
  a <- 2 * rank(tied$first)
  b <- 2 * rank(tied$second)
  orders <- arrangements(n)
  sums <- matrix(b[orders], nrow(orders)) %*% a - sum(a) * sum(b) / n
  found <- sum(a * b) - sum(a) * sum(b) / n
  answer(paste(n, "pairs"), r = cor(a, b), p = mean(abs(sums) >= abs(found) - 1e-9))
}
finish()
